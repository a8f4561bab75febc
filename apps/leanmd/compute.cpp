#include "apps/leanmd/compute.hpp"

#include "apps/charge.hpp"

#include <chrono>
#include <utility>

namespace leanmd {
namespace {

constexpr std::chrono::nanoseconds per_pair{3};  // as measured

}  // namespace

std::size_t Compute::n_cells() const {
  const auto& x = index().x;
  return x[0] == x[3] && x[1] == x[4] && x[2] == x[5] ? 1 : 2;
}

// A cell sends its next coordinates when it has the forces of this step, so none are more than one
// step ahead, and those of the next step come only after this element has contributed to this one.
void Compute::take(Coordinates coordinates) {
  waiting_.push_back(std::move(coordinates));
  if (!at_barrier_ && waiting_.size() == n_cells()) interact();
}

void Compute::interact() {
  const std::vector<Coordinates> cells = std::exchange(waiting_, {});
  std::vector<Forces> forces(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    forces[c].step = cells[c].step;
    forces[c].on.resize(cells[c].of_atoms.size());
  }
  if (cells.size() == 1) {
    law_.add(cells[0].of_atoms.view(), forces[0]);
    apps::charge(per_pair, cells[0].of_atoms.size() * cells[0].of_atoms.size() / 2);
  } else {
    law_.add(cells[0].of_atoms.view(), cells[1].of_atoms.view(), forces[0], forces[1]);
    apps::charge(per_pair, cells[0].of_atoms.size() * cells[1].of_atoms.size());
  }
  for (std::size_t c = 0; c < cells.size(); ++c)
    contribute(cells[c].section, AddForces{}, std::move(forces[c]), cells[c].forces);
  if (sync_every_ != 0 && ++n_steps_ % sync_every_ == 0) {
    at_barrier_ = true;
    at_sync();
  }
}

void Compute::resume_from_sync() {
  at_barrier_ = false;
  if (waiting_.size() == n_cells()) interact();
}

}  // namespace leanmd
