#include "apps/leanmd/cell.hpp"

#include "runtime/more/section.hpp"
#include "runtime/more/shared_array.hpp"

#include <utility>

namespace leanmd {

// One of the two cells of a pair creates its compute; both have it in their sections.
void Cell::create_computes() {
  const LennardJones law(problem_.box.edge, problem_.cutoff);
  std::vector<tess::Index6> pairs;
  for (const tess::Index3& other :
       problem_.box.cells_within(problem_.cutoff + problem_.skin, index())) {
    pairs.push_back(pair_of(index(), other));
    if (index() <= other) all_computes_[pairs.back()].insert(law);
  }
  computes_ = tess::create_section(all_computes_, std::move(pairs));
}

void Cell::begin(Run run) {
  run_ = std::move(run);
  self().send<&Cell::step>(run_.first);
}

tess::Task Cell::step(std::int32_t step) {
  if (step > 0) atoms_.advance(step);
  if (step > 0 && problem_.exchanges_at(step)) {
    auto leavers = atoms_.take_out(index());
    for (auto& [cell, atoms] : leavers)
      array()[cell].send<&Cell::receive_atoms>(Arrivals{step, std::move(atoms)});
    for (std::size_t n = leavers.size(); n > 0; --n) {
      const Arrivals arrivals = co_await arrivals_.take(step);
      atoms_.add(arrivals.atoms);
    }
  }
  computes_.broadcast<&Compute::take>(
      Coordinates{step, tess::SharedArray<Position>(atoms_.positions()), computes_,
                  self().target<&Cell::receive_forces>()});
  Forces forces = co_await forces_.take(step);
  energies_.push_back(atoms_.finish(std::move(forces)));
  if (step < run_.last)
    self().send<&Cell::step>(step + 1);
  else
    contribute(tess::sum, atoms_.totals(std::exchange(energies_, {})), run_.done);
}

}  // namespace leanmd
