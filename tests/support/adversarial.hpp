// A simulated machine for tests that any schedule must pass: --sim pes=N,cost=100ns,seed=S.
#pragma once

#include "runtime/runtime.hpp"
#include "runtime/wire/machine/simulated.hpp"

#include <cstdint>

namespace tess::test {

/// Delivers messages in an adversarial order and migrates chares by force, both drawn from the
/// seed.
[[nodiscard]] inline Setup adversarial(int n_pes, std::uint64_t seed) {
  SimulatedOptions options;
  options.n_pes = n_pes;
  options.cost = Time(100);
  options.seed = seed;
  RuntimeOptions runtime_options;
  runtime_options.seed = seed;
  runtime_options.migration_chance = migration_chance(options);
  return {make_simulated_machine(options), runtime_options};
}

}  // namespace tess::test
