// Finds the cell of a piece whose foot is nearest to a point (foot.hpp), with a tree of boxes over
// the cells: for walls and lines, which hold hardly any point, and for points outside of a volume.
// Each piece of a source has one. Over several pieces the best answer is that of better(), so it does
// not depend on the cut. The tree does not change after it is built.
#pragma once

#include "collide/box_tree.hpp"
#include "m2m/mesh_view.hpp"
#include "m2m/rows/interpolate/foot.hpp"
#include "m2m/rows/search/best_donors.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// Boxes beyond this squared distance hold no foot within the distance, though rounding may bring a
/// foot a little nearer than its box.
[[nodiscard]] inline double squared_limit(double distance) {
  return distance * distance * (1 + 4e-12);
}

class NearestCells {
 public:
  /// Builds the tree over the piece's own cells. O(n log n).
  explicit NearestCells(const MeshView& mesh);

  /// The nearest cell of each point that has one within its reach (inclusive). `mesh`: that of the
  /// constructor. Adds to `n_tested` the pairs of a cell and a point that were compared.
  [[nodiscard]] BestDonors within(const MeshView& mesh, std::span<const Point> points,
                                  std::span<const double> reaches, std::uint64_t& n_tested) const;
  /// Finds them with one reach for all points, and for each cell at least its snap_reach().
  [[nodiscard]] BestDonors snapped(const MeshView& mesh, std::span<const Point> points,
                                   double tolerance, std::uint64_t& n_tested) const;

 private:
  struct Best {
    std::int32_t cell = -1;
    std::uint32_t leaf = 0;  // of the tree, that holds it
    Candidate candidate{};
    Foot foot{};
  };
  struct Reach {
    double length = 0;
    bool snaps = false;  // also within the snap_reach() of a cell
  };
  /// Looks at the leaves around the leaf `hint` first.
  [[nodiscard]] Best find(const MeshView& mesh, const Point& p, Reach reach, std::uint32_t hint,
                          std::uint64_t& n_tested) const;
  template <class ReachOf>
  [[nodiscard]] BestDonors find_all(const MeshView& mesh, std::span<const Point> points,
                                    const ReachOf& reach_of, std::uint64_t& n_tested) const;

  collide::BoxTree<Aabb, 3> tree_;
  std::vector<std::uint32_t> parents_;  // of nodes 2 k + 1 and 2 k + 2, which are siblings
  std::vector<Aabb> boxes_;             // of the cells, by their places in the tree
  double most_snap_reach_ = 0;          // not less than that of any cell
};

}  // namespace tess::m2m
