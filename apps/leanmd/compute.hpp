// The forces between two cells, or within one: an element of a sparse array with the index of the
// pair (pair_of). It is a member of its cells' sections. Nearly all work of the program is here, so
// these are the elements that are balanced.
//
//     take (one cell's coordinates) … take (the other's) -> interact -> contribute to both sections
#pragma once

#include "apps/leanmd/forces.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/shared_array.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <vector>

namespace leanmd {

class Compute;

/// What a cell multicasts in a step: its coordinates, and where the forces go.
struct Coordinates {
  std::int32_t step = 0;
  tess::SharedArray<Position> of_atoms;
  tess::SectionProxy<Compute> section;
  tess::Callback<Forces> forces;
};

class Compute : public tess::Chare<Compute, tess::Index6> {
 public:
  Compute() = default;
  explicit Compute(const LennardJones& law) : law_(law) {}

  /// Steps between balance barriers; 0: none. Called before a run.
  void set_barrier(std::int32_t every) { sync_every_ = every; }
  void take(Coordinates coordinates);
  void resume_from_sync();

  /// For balancers that keep neighbours together: the place of the first of the two cells.
  [[nodiscard]] std::array<double, 3> balance_position() const {
    const auto& x = index().x;
    return {1.0 * x[0], 1.0 * x[1], 1.0 * x[2]};
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(law_, sync_every_, waiting_, n_steps_, at_barrier_);
  }

 private:
  void interact_if_complete();

  LennardJones law_;
  std::int32_t sync_every_ = 0;
  std::vector<Coordinates> waiting_;  // of the next step
  std::int32_t n_steps_ = 0;
  bool at_barrier_ = false;
};

}  // namespace leanmd
