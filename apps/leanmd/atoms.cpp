#include "apps/leanmd/atoms.hpp"

#include <algorithm>
#include <iterator>

namespace leanmd {

Totals operator+(Totals a, const Totals& b) {
  for (std::size_t s = 0; s < a.energies.size(); ++s)
    for (std::size_t k = 0; k < 3; ++k) a.energies[s][k] += b.energies[s][k];
  for (std::size_t k = 0; k < 3; ++k) a.momentum[k] += b.momentum[k];
  a.n_atoms += b.n_atoms;
  a.hash += b.hash;
  if (b.trouble && (!a.trouble || b.trouble < a.trouble)) a.trouble = b.trouble;
  return a;
}

void Atoms::add(const std::vector<Atom>& atoms) {
  std::ranges::copy(atoms, std::back_inserter(atoms_));
}

void Atoms::advance(std::int32_t step) {
  if (trouble_) return;
  Motion::kick(atoms_, forces_.on);
  Trouble fastest;
  for (const Atom& atom : atoms_)
    fastest = std::max(fastest, {step, Trouble::Kind::too_fast, motion_.speed(atom), atom.id});
  // At an exchange atoms can leave for the cells around; between two they stay within the skin, so
  // that all pairs within the cutoff are found.
  const bool exchanges = problem_.exchanges_at(step);
  const Box& box = problem_.box;
  const double most = exchanges ? std::min(box.least_cell_edge(), box.edge / 4) : problem_.skin / 2;
  moved_ += fastest.value * problem_.dt;
  if (fastest.value > greatest_speed || moved_ > most) {
    trouble_ = fastest;
    if (fastest.value <= greatest_speed && !exchanges)
      trouble_ = {step, Trouble::Kind::too_far, moved_, fastest.atom};
    return;
  }
  motion_.drift(atoms_);
  if (exchanges) moved_ = 0;
}

std::map<tess::Index3, std::vector<Atom>> Atoms::take_out(const tess::Index3& own) {
  std::map<tess::Index3, std::vector<Atom>> by_cell;
  for (const tess::Index3& cell : problem_.box.cells_touching(own)) by_cell[cell];
  for (const Atom& atom : std::exchange(atoms_, {}))
    by_cell.at(trouble_ ? own : problem_.box.cell_of(atom.at)).push_back(atom);
  return by_cell;
}

std::vector<Position> Atoms::positions() const {
  std::vector<Position> positions;
  for (const Atom& atom : atoms_) positions.push_back(atom.at);
  return positions;
}

Vector Atoms::finish(Forces forces) {
  forces_ = std::move(forces);
  if (forces_.closest >= 0 && !trouble_)
    trouble_ = {forces_.step, Trouble::Kind::too_close, forces_.closest_distance,
                atoms_[static_cast<std::size_t>(forces_.closest)].id};
  if (trouble_) return {};  // the energies might overflow
  if (forces_.step > 0) Motion::kick(atoms_, forces_.on);
  std::int64_t kinetic = 0;
  for (const Atom& atom : atoms_) kinetic += motion_.energy(atom);
  return {kinetic, forces_.energy, kinetic + forces_.energy};
}

void Atoms::reverse() {
  for (Atom& atom : atoms_)
    for (std::int64_t& v : atom.velocity) v = -v;
}

std::vector<AtomForce> Atoms::with_forces() const {
  std::vector<AtomForce> all;
  for (std::size_t i = 0; i < atoms_.size(); ++i) all.emplace_back(atoms_[i], forces_.on[i]);
  return all;
}

Totals Atoms::totals(std::vector<Vector> energies) const {
  Totals totals{.energies = std::move(energies),
                .n_atoms = static_cast<std::int64_t>(atoms_.size()),
                .trouble = trouble_};
  for (const Atom& atom : atoms_) {
    for (std::size_t k = 0; k < 3; ++k) totals.momentum[k] += atom.velocity[k];
    totals.hash += hash_of(atom);
  }
  return totals;
}

}  // namespace leanmd
