// A run: in each step panel and fluid exchange displacements and forces until they agree.
#pragma once

#include "apps/fsi/problem.hpp"
#include "apps/kit/checkpoints.hpp"
#include "runtime/balance.hpp"

#include <cstdint>
#include <functional>
#include <optional>

namespace fsi {

struct Settings {
  Problem problem;
  std::optional<tess::BalanceOptions> balance{};
  std::int32_t balance_every = 5;  ///< steps
  kit::Checkpoints checkpoints{};
};

struct Outcome {
  double seconds = 0;
  std::int64_t n_iterations = 0;
  bool diverged = false;    ///< a step did not agree: nothing below holds
  double error = 0;         ///< at the end, largest distance from the exact displacement; of a
  double energy_drift = 0;  ///< of the energy at the start: the largest of all steps
  /// What the forces on the panel differ from those of the fluid: sum, moments and work; each of
  /// the sum of its terms' magnitudes, the largest of all steps.
  double force_gap = 0, moment_gap = 0, work_gap = 0;
  std::uint64_t n_moved = 0, hash = 0;
};

/// `part` is called with each step; it may be empty.
tess::Task simulate(Settings& settings, Outcome& outcome,
                    std::function<void(std::int32_t)> part = {});

}  // namespace fsi
