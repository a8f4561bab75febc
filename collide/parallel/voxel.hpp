// A voxel is an element of a sparse three-dimensional array. The first objects that touch it create
// it, on the PE that they come from (Lawlor and Kalé 2002, section 3.3). When all objects are
// delivered, each voxel solves a serial problem of its own. Empty space costs nothing: it has no
// voxels, and a voxel that is empty in a collision, because its objects have moved on, is
// destroyed. A voxel with objects of a single model skips the search if pairs within a model do not
// count (section 4.2).
#pragma once

#include "collide/hit.hpp"
#include "collide/parallel/report.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <vector>

namespace tess::collide {

/// The parameters of a collision, the same for all voxels.
struct Collision {
  Point origin{};  ///< of the grid
  Point size{};    ///< of a voxel
  PairRules rules;
  Report report;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(origin, size, rules, report);
  }
};

class Voxel : public Chare<Voxel, Index3> {
 public:
  /// Adds objects that touch this voxel.
  void add(std::vector<Item> items);

  /// Finds the pairs that this voxel is responsible for, sends them to the owners, and drops the
  /// objects. A voxel without objects is destroyed.
  void start_collision(const Collision& collision);

  /// The position for load balancing, in units of voxels.
  [[nodiscard]] std::array<double, 3> balance_position() const {
    return {1.0 * index().x, 1.0 * index().y, 1.0 * index().z};
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(items_);
  }

 private:
  std::vector<Item> items_;
};

}  // namespace tess::collide
