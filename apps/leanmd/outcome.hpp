// What is known of a run, and whether it is right.
#pragma once

#include "apps/leanmd/atoms.hpp"
#include "runtime/balance.hpp"

#include <string>
#include <vector>

namespace leanmd {

/// What no step changes.
struct Conserved {
  std::int64_t n_atoms = 0;
  Vector momentum{};

  [[nodiscard]] static Conserved of(const std::vector<Atom>& atoms);
};

struct Outcome {
  std::vector<Vector> energies;  ///< as Totals::energies, from step 0 on
  std::int64_t most_change = 0;  ///< of the total energy since step 0
  std::int64_t most_kinetic = 0;
  std::int64_t n_atoms = 0;  ///< at the end
  std::uint64_t first_hash = 0, hash = 0;
  std::int64_t wrong_forces = -1;  ///< atoms whose force is not that of all pairs; -1: not compared
  std::string error;  ///< why the run ended early, or what is wrong with its result; empty: none
  bool is_wrong = false;  ///< the error is a wrong result, of which no option is the cause
  double seconds = 0;
  std::vector<tess::balance::Round> rounds;

  /// Some more steps are done, and `step` of them all; sets the error if something is wrong.
  void add(const Totals& totals, const Problem& problem, const Conserved& kept, std::int32_t step);
  /// Compares forces with those of all pairs, bit for bit.
  void compare_forces(const Problem& problem, const std::vector<AtomForce>& all);

  /// Per atom, in units of energy: the total energy at the start, and its greatest change.
  [[nodiscard]] double energy() const;
  [[nodiscard]] double drift() const;
  /// The greatest kinetic energy per atom.
  [[nodiscard]] double kinetic() const;
};

}  // namespace leanmd
