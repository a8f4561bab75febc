#include "apps/leanmd/outcome.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace leanmd {
namespace {

/// Above this share of the kinetic energy a change of the total energy is an instability.
constexpr double unstable_share = 0.1;

}  // namespace

Conserved Conserved::of(const std::vector<Atom>& atoms) {
  Conserved kept{static_cast<std::int64_t>(atoms.size()), {}};
  for (const Atom& atom : atoms)
    for (std::size_t k = 0; k < 3; ++k) kept.momentum[k] += atom.velocity[k];
  return kept;
}

void Outcome::add(const Totals& totals, const Problem& problem, const Conserved& kept,
                  std::int32_t step) {
  const std::size_t n_before = energies.size();
  std::ranges::copy(totals.energies, std::back_inserter(energies));
  n_atoms = totals.n_atoms;
  hash = totals.hash;
  if (totals.trouble) {
    error = describe(totals.trouble, problem);
    energies.resize(static_cast<std::size_t>(std::max(1, totals.trouble.step)));
  }
  for (std::size_t i = n_before; i < energies.size(); ++i) {
    most_change = std::max(most_change, std::abs(energies[i][2] - energies.front()[2]));
    most_kinetic = std::max(most_kinetic, energies[i][0]);
  }
  if (totals.trouble) return;
  if (n_atoms != kept.n_atoms) {
    error = fmt::format("{} atoms of {} are there", n_atoms, kept.n_atoms);
    is_wrong = true;
  } else if (totals.momentum != kept.momentum) {
    error = "the total momentum has changed: a force was lost or doubled";
    is_wrong = true;
  } else if (drift() > unstable_share * kinetic()) {
    error = fmt::format(
        "unstable until step {}: the total energy per atom changed by {:.3g}, the kinetic energy "
        "is {:.3g}; lower --dt {}",
        step, drift(), kinetic(), problem.dt);
  }
}

void Outcome::compare_forces(const Problem& problem, const std::vector<AtomForce>& all) {
  std::vector<Position> positions;
  for (const auto& [atom, force] : all) positions.push_back(atom.at);
  Forces expected;
  expected.on.resize(all.size());
  LennardJones(problem.box.edge, problem.cutoff).add(positions, expected);
  wrong_forces = std::max<std::int64_t>(0, wrong_forces);
  for (std::size_t i = 0; i < all.size(); ++i)
    wrong_forces += all[i].second == expected.on[i] ? 0 : 1;
  if (wrong_forces == 0) return;
  error = fmt::format("{} forces differ from those of all pairs", wrong_forces);
  is_wrong = true;
}

double Outcome::energy() const {
  return static_cast<double>(energies.front()[2]) * energy_quantum / static_cast<double>(n_atoms);
}

double Outcome::drift() const {
  return static_cast<double>(most_change) * energy_quantum / static_cast<double>(n_atoms);
}

double Outcome::kinetic() const {
  return static_cast<double>(most_kinetic) * energy_quantum / static_cast<double>(n_atoms);
}

}  // namespace leanmd
