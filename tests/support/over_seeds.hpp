// A test's program on the simulated machine, over seeds.
#pragma once

#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <cstdint>
#include <string>

namespace tests {

/// The machine of the tests of public types: two virtual processes, messages in any order.
inline constexpr const char* two_processes = "pes=4,per-process=2,cost=100ns";

/// Runs `main` with the seeds 0 … n_seeds − 1, each of which must end well.
template <class Main>
void over_seeds(std::uint64_t n_seeds, const std::string& keys, Main main) {
  for (std::uint64_t seed = 0; seed < n_seeds; ++seed) {
    tess::RuntimeOptions options;
    options.seed = seed;
    const Ending ending = run(tess::text(keys, ",seed=", seed), main, options);
    INFO("seed " << seed << "\n" << ending.report);
    REQUIRE(ending.exit_code == 0);
  }
}

}  // namespace tests
