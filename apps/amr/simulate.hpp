// A run of amr: the tree, the steps between two changes of it, and what is known at the end.
#pragma once

#include "apps/amr/block.hpp"
#include "apps/kit/checkpoints.hpp"
#include "runtime/balance_options.hpp"

#include <functional>
#include <optional>

namespace amr {

struct Settings {
  Problem problem;
  std::int32_t change_every = 4;  ///< steps between two changes of the tree
  std::optional<tess::BalanceOptions> balance;
  kit::Checkpoints checkpoints;
};

struct Outcome {
  Census end;
  std::int64_t mass_at_start = 0;  ///< quanta
  std::int64_t n_created = 0, n_destroyed = 0;
  std::int64_t most_blocks = 0;
  std::int64_t cell_steps = 0;  ///< cells × steps
  std::uint64_t n_moved = 0;    ///< by the balancer
  double seconds = 0;           ///< of the steps

  [[nodiscard]] double l1() const { return static_cast<double>(end.norms.l1) * 0x1p-60; }
  [[nodiscard]] double l2() const;
};

/// `part` is called with the number of steps that are done. Called in the main coroutine. After a
/// restart the problem of `settings` is that of the checkpoint.
tess::Task simulate(Settings& settings, Outcome& outcome,
                    std::function<void(std::int32_t)> part = {});

}  // namespace amr
