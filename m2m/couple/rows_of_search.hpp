// The rows of values that a source piece had in the last search. Its donors are positions among
// them, so a piece whose mesh has changed since would read other memory.
#pragma once

#include "m2m/mesh_view.hpp"
#include "m2m/rows/conservative/overlap_rows.hpp"
#include "m2m/transfer_kind.hpp"
#include "runtime/core/check.hpp"

#include <cstdint>

namespace tess::m2m {

class RowsOfSearch {
 public:
  void set(const MeshView& mesh, Centring values) { n_ = n_unknowns(mesh, values); }
  void check(std::uint64_t n_rows) const {
    TESS_CHECK(
        n_rows == n_, "a piece has ", n_rows, " rows of values, and had ", n_,
        " in the last search of the coupling: search again when points or tetrahedra change");
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_);
  }

 private:
  std::uint64_t n_ = 0;
};

}  // namespace tess::m2m
