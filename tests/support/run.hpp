// One run of a program on a machine of a test, in one call:
//
//     CHECK(tests::run("pes=3,cost=100ns", main).exit_code == 0);
//     CHECK(tests::run_threads(2, main).ok());
//
// A machine that delays messages and shrinks what fails is tess::test::Machine.
#pragma once

#include "runtime/machine/simulated.hpp"
#include "runtime/machine/threads.hpp"
#include "runtime/testing.hpp"

#include <memory>
#include <string>
#include <utility>

namespace tests {

/// Runs `main` on PE 0 of this machine, to the end of the run.
template <class Main>
tess::test::Result run_on(std::unique_ptr<tess::Machine> machine, Main main,
                          tess::RuntimeOptions options = {}) {
  tess::test::Result result;
  options.report = [&result](const std::string& line) { result.report.push_back(line); };
  tess::Setup setup{std::move(machine), std::move(options)};
  result.exit_code = tess::run(setup, std::move(main));
  return result;
}

/// The same on the simulated machine that the keys describe, as those of --sim.
template <class Main>
tess::test::Result run(const std::string& keys, Main main, tess::RuntimeOptions options = {}) {
  return run_on(tess::make_simulated_machine(tess::parse_simulated(keys)), std::move(main),
                std::move(options));
}

/// The same on threads of this process.
template <class Main>
tess::test::Result run_threads(int n_pes, Main main, tess::RuntimeOptions options = {}) {
  return run_on(tess::make_threads_machine(n_pes), std::move(main), std::move(options));
}

}  // namespace tests
