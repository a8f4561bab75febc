#include "apps/leanmd/cell.hpp"

#include <algorithm>
#include <iterator>
#include <map>

namespace leanmd {

Totals AddTotals::operator()(Totals a, const Totals& b) const {
  for (std::size_t s = 0; s < a.energies.size(); ++s)
    for (std::size_t k = 0; k < 3; ++k) a.energies[s][k] += b.energies[s][k];
  for (std::size_t k = 0; k < 3; ++k) a.momentum[k] += b.momentum[k];
  a.n_atoms += b.n_atoms;
  a.hash += b.hash;
  if (b.trouble && (!a.trouble || b.trouble < a.trouble)) a.trouble = b.trouble;
  return a;
}

std::vector<tess::Index3> Cell::partners() const {
  return problem_.box.cells_within(problem_.cutoff + problem_.skin, index());
}

void Cell::create_computes() {
  const LennardJones law(problem_.box.edge, problem_.cutoff);
  for (const tess::Index3& other : partners())
    if (index() <= other) all_computes_[pair_of(index(), other)].insert(law);
}

void Cell::create_section() {
  std::vector<tess::Index6> members;
  for (const tess::Index3& other : partners()) members.push_back(pair_of(index(), other));
  computes_ = tess::create_section(all_computes_, std::move(members));
}

void Cell::begin(Run run) {
  run_ = std::move(run);
  totals_.energies.clear();
  self().send<&Cell::step>(run_.first);
}

tess::Task Cell::step(std::int32_t step) {
  if (step > 0) {
    advance(step);
    if (step % problem_.exchange_every == 0) {
      send_leavers(step);
      for (std::size_t n = problem_.box.cells_touching(index()).size(); n > 0; --n) {
        const Arrivals arrivals = co_await arrivals_box_.take(step);
        std::ranges::copy(arrivals.atoms, std::back_inserter(atoms_));
      }
    }
  }
  std::vector<Position> positions;
  for (const Atom& atom : atoms_) positions.push_back(atom.at);
  Coordinates coordinates{step, tess::SharedArray<Position>(std::move(positions)), computes_,
                          self().target<&Cell::receive_forces>()};
  computes_.broadcast<&Compute::take>(std::move(coordinates));
  forces_ = co_await forces_box_.take(step);
  check_forces();
  if (step > 0 && !totals_.trouble) Motion::kick(atoms_, forces_.on);

  totals_.energies.push_back(energies());
  if (step < run_.last) {
    self().send<&Cell::step>(step + 1);
  } else {
    sum_up();
  }
}

void Cell::advance(std::int32_t step) {
  if (totals_.trouble) return;
  Motion::kick(atoms_, forces_.on);
  Trouble fastest;
  for (const Atom& atom : atoms_)
    fastest = std::max(fastest, {step, Trouble::Kind::too_fast, motion_.speed(atom), atom.id});
  // At an exchange atoms can leave for the cells around; between two they stay within the skin, so
  // that all pairs within the cutoff are found.
  const bool exchanges = step % problem_.exchange_every == 0;
  const Box& box = problem_.box;
  const double most = exchanges ? std::min(box.least_cell_edge(), box.edge / 4) : problem_.skin / 2;
  moved_ += fastest.value * problem_.dt;
  if (fastest.value > greatest_speed || moved_ > most) {
    totals_.trouble = fastest;
    if (fastest.value <= greatest_speed && !exchanges)
      totals_.trouble = {step, Trouble::Kind::too_far, moved_, fastest.atom};
    return;
  }
  motion_.drift(atoms_);
  if (exchanges) moved_ = 0;
}

void Cell::send_leavers(std::int32_t step) {
  std::map<tess::Index3, std::vector<Atom>> leavers;
  for (const tess::Index3& cell : problem_.box.cells_touching(index())) leavers[cell];
  for (const Atom& atom : std::exchange(atoms_, {}))
    leavers.at(totals_.trouble ? index() : problem_.box.cell_of(atom.at)).push_back(atom);
  for (auto& [cell, atoms] : leavers)
    array()[cell].send<&Cell::receive_atoms>(Arrivals{step, std::move(atoms)});
}

void Cell::check_forces() {
  if (forces_.closest < 0 || totals_.trouble) return;
  totals_.trouble = {forces_.step, Trouble::Kind::too_close, forces_.closest_distance,
                     atoms_[static_cast<std::size_t>(forces_.closest)].id};
}

Vector Cell::energies() const {
  if (totals_.trouble) return {};  // they might overflow
  std::int64_t kinetic = 0;
  for (const Atom& atom : atoms_) kinetic += motion_.energy(atom);
  return {kinetic, forces_.energy, kinetic + forces_.energy};
}

void Cell::reverse() {
  for (Atom& atom : atoms_)
    for (std::int64_t& v : atom.velocity) v = -v;
}

void Cell::show(const tess::Callback<std::vector<AtomForce>>& result) {
  std::vector<AtomForce> all;
  for (std::size_t i = 0; i < atoms_.size(); ++i) all.emplace_back(atoms_[i], forces_.on[i]);
  contribute(tess::concatenate, std::move(all), result);
}

void Cell::sum_up() {
  totals_.momentum = {};
  totals_.n_atoms = static_cast<std::int64_t>(atoms_.size());
  totals_.hash = 0;
  for (const Atom& atom : atoms_) {
    for (std::size_t k = 0; k < 3; ++k) totals_.momentum[k] += atom.velocity[k];
    totals_.hash += hash_of(atom);
  }
  contribute(AddTotals{}, totals_, run_.done);
}

}  // namespace leanmd
