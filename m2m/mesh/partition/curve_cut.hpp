// Cuts a Hilbert curve into pieces with equally many tetrahedra, from counts alone. So any number
// of PEs can cut a mesh together, and the result does not depend on their number: the counts of all
// PEs are added, and integers have no rounding.
//
//     round 0   counts of all cells of level 4, or 5 with many parts
//     round 1   counts of the 64 cells in each cell where a cut should be and that holds too many
//     …         until the cut can stand at the border of a cell
//
// One PE, the one that receives the sums, calls refine(); then all call parts().
#pragma once

#include "m2m/mesh/partition/cell_counts.hpp"
#include "m2m/mesh/partition/hilbert_cube.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

class CurveCut {
 public:
  CurveCut() = default;
  CurveCut(std::uint64_t n_tets, std::int32_t n_parts);

  /// True once no more counts are needed.
  [[nodiscard]] bool is_done() const { return open_.empty(); }
  /// Counts of this round for some tetrahedra. `cells`: HilbertCube::cell() of each centroid.
  [[nodiscard]] CellCounts counts(std::span<const std::uint64_t> cells) const;
  /// Decides with the counts of all tetrahedra, and starts the next round. Parts differ by at most
  /// 1/16 of their size, unless more tetrahedra than that have the same cell of the last level.
  void refine(const CellCounts& all);

  /// How many tetrahedra of the whole mesh the parts from `first` to before `end` get. Valid once
  /// is_done().
  [[nodiscard]] std::uint64_t n_tets_of(std::int32_t first, std::int32_t end) const;
  /// The part of every tetrahedron.
  [[nodiscard]] std::vector<std::int32_t> parts(std::span<const std::uint64_t> cells) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_tets_, n_parts_, level_, first_, end_, open_, before_, cuts_, n_before_cuts_, cut_level_);
  }

 private:
  [[nodiscard]] int next_level() const;
  [[nodiscard]] std::uint64_t target(std::int32_t cut) const;

  std::uint64_t n_tets_ = 0;
  std::int32_t n_parts_ = 1;
  std::int32_t level_ = 0;                    // of the open cells
  std::vector<std::int32_t> first_;           // per open cell: the first cut in it
  std::vector<std::int32_t> end_;             // and the cut after the last one in it
  std::vector<std::uint64_t> open_;           // positions of the cells that are counted, ascending
  std::vector<std::uint64_t> before_;         // per open cell: tetrahedra before it on the curve
  std::vector<std::uint64_t> cuts_;           // position where part i + 1 begins, at the last level
  std::vector<std::uint64_t> n_before_cuts_;  // tetrahedra before each of these positions
  std::int32_t cut_level_ = 0;                // cuts stand at borders of cells of this level
};

}  // namespace tess::m2m
