// A simulation on the machine: makes the arrays, runs all steps, and compares what can be compared.
#pragma once

#include "apps/checkpoints.hpp"
#include "apps/leanmd/cell.hpp"
#include "apps/progress.hpp"
#include "runtime/balance.hpp"

#include <optional>
#include <string>
#include <vector>

namespace leanmd {

struct Options {
  Problem problem;
  std::int32_t n_steps = 100;
  std::optional<tess::BalanceOptions> balance;
  /// Compares all forces of the first step and of the last with those of all pairs.
  bool check = false;
  /// Afterwards reverses all velocities and runs back: the atoms return to their start, bit for bit.
  bool reverse = false;
  apps::Progress* progress = nullptr;
  apps::Checkpoints checkpoints;
};

struct Outcome {
  std::vector<Vector> energies;  ///< as Totals::energies, from step 0 on
  std::int64_t n_atoms = 0;      ///< at the end
  std::uint64_t first_hash = 0, hash = 0;
  std::int64_t wrong_forces = -1;  ///< atoms whose force is not that of all pairs; -1: not compared
  std::string error;  ///< why the run ended early, or what is wrong with its result; empty: none
  double seconds = 0;
  std::vector<tess::balance::Round> rounds;

  /// Per atom, in units of energy: the total energy at the start, and its greatest change.
  [[nodiscard]] double energy() const;
  [[nodiscard]] double drift() const;
  /// The greatest kinetic energy per atom.
  [[nodiscard]] double kinetic() const;
};

/// Called on PE 0. The outcome is the same on every machine and for any cells. A restart needs no
/// atoms; problem and steps of `options` become those of the checkpoint.
tess::Task simulate(Options& options, std::vector<Atom> atoms, Outcome& outcome);

}  // namespace leanmd
