#include "apps/leanmd/cell.hpp"

#include "runtime/more/monitor.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/shared_array.hpp"

#include <algorithm>
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
  draw();
  if (step < run_.last)
    self().send<&Cell::step>(step + 1);
  else
    contribute(tess::sum, atoms_.totals(std::exchange(energies_, {})), run_.done);
}

void Cell::draw() const {
  const auto& cells = problem_.box.n_cells;
  const std::int32_t n = std::min(8, 1024 / std::max(cells[0], cells[1]));  // pixels of an edge
  if (n == 0 || index().z != 0) return;
  tess::show("atoms in the lowest layer of cells", [&] {
    const Box pixels{1, {n * cells[0], n * cells[1], 1}};
    tess::Picture part{pixels.n_cells[0], pixels.n_cells[1], n * index().x, n * index().y, n, {}};
    part.values.resize(static_cast<std::size_t>(n * n));
    for (const Position& atom : atoms_.positions()) {
      const tess::Index3 at = pixels.cell_of(atom);
      const std::int32_t x = at.x - part.x, y = at.y - part.y;  // may be on its way to another cell
      if (x >= 0 && x < n && y >= 0 && y < n) ++part.values[static_cast<std::size_t>(y * n + x)];
    }
    return part;
  });
}

}  // namespace leanmd
