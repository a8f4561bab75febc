#include "apps/leanmd/compute.hpp"

#include "apps/kit/charge.hpp"

#include <chrono>
#include <utility>

namespace leanmd {
namespace {

constexpr std::chrono::nanoseconds per_pair{3};  // as measured

}  // namespace

// A cell sends its next coordinates when it has the forces of this step, so none are more than one
// step ahead, and those of the next step come only after this element has contributed to this one.
void Compute::take(Coordinates coordinates) {
  waiting_.push_back(std::move(coordinates));
  interact_if_complete();
}

void Compute::resume_from_sync() {
  at_barrier_ = false;
  interact_if_complete();
}

void Compute::interact_if_complete() {
  if (at_barrier_ || waiting_.size() < n_cells_of(index())) return;
  const std::vector<Coordinates> cells = std::exchange(waiting_, {});
  std::vector<Forces> forces;
  for (const Coordinates& cell : cells)
    forces.push_back({.step = cell.step, .on = std::vector<Vector>(cell.of_atoms.size())});
  const auto first = cells.front().of_atoms.view(), last = cells.back().of_atoms.view();
  if (cells.size() == 1) {
    law_.add(first, forces[0]);
    kit::charge(per_pair, first.size() * first.size() / 2);
  } else {
    law_.add(first, last, forces[0], forces[1]);
    kit::charge(per_pair, first.size() * last.size());
  }
  for (std::size_t c = 0; c < cells.size(); ++c)
    contribute(cells[c].section, AddForces{}, std::move(forces[c]), cells[c].forces);
  if (sync_every_ != 0 && ++n_steps_ % sync_every_ == 0) {
    at_barrier_ = true;
    at_sync();
  }
}

}  // namespace leanmd
