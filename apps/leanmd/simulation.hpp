// A simulation on the machine: makes the arrays, runs all steps, and compares what can be compared.
#pragma once

#include "apps/kit/checkpoints.hpp"
#include "apps/kit/progress.hpp"
#include "apps/leanmd/outcome.hpp"

#include <optional>

namespace leanmd {

struct Options {
  Problem problem;
  std::int32_t n_steps = 100;
  std::optional<tess::BalanceOptions> balance;
  /// Compares all forces of the first step and of the last with those of all pairs.
  bool check = false;
  /// Afterwards reverses all velocities and runs back: the atoms return to their start, bit for
  /// bit.
  bool reverse = false;
  kit::Progress* progress = nullptr;
  kit::Checkpoints checkpoints;
};

/// Called on PE 0. The outcome is the same on every machine and for any cells. A restart needs no
/// atoms; problem and steps of `options` become those of the checkpoint.
tess::Task simulate(Options& options, std::vector<Atom> atoms, Outcome& outcome);

}  // namespace leanmd
