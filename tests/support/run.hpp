// One run of a program on a machine of a test, in one call:
//
//     CHECK(tests::run("pes=3,cost=100ns", main).exit_code == 0);
//     CHECK(tests::run_threads(2, main).report == "");
//
// A machine that delays messages and shrinks what fails is tess::test::Machine.
#pragma once

#include "runtime/core/text.hpp"
#include "runtime/machine/simulated.hpp"
#include "runtime/machine/threads.hpp"
#include "runtime/run.hpp"

#include <memory>
#include <string>
#include <utility>

namespace tests {

/// How a run ended.
struct Ending {
  int exit_code = 0;
  /// What the runtime would have printed to standard error, lines; without the remark on work that
  /// virtual time leaves out, which depends on the load of the host.
  std::string report;
};

/// Runs `main` on PE 0 of this machine, to the end of the run.
template <class Main>
Ending run_on(std::unique_ptr<tess::Machine> machine, Main main,
              tess::RuntimeOptions options = {}) {
  Ending ending;
  options.report = [&ending](const std::string& line) {
    if (line.find("virtual time leaves out") == std::string::npos) ending.report += line + "\n";
  };
  tess::Setup setup{std::move(machine), std::move(options)};
  ending.exit_code = tess::run(setup, std::move(main));
  return ending;
}

/// The same on the simulated machine that the keys describe, as those of --sim do; what they say
/// about migrations is left to the options.
template <class Main>
Ending run(const std::string& keys, Main main, tess::RuntimeOptions options = {}) {
  return run_on(tess::make_simulated_machine(tess::parse_simulated(keys)), std::move(main),
                std::move(options));
}

/// The same on threads of this process.
template <class Main>
Ending run_threads(int n_pes, Main main, tess::RuntimeOptions options = {}) {
  return run_on(tess::make_threads_machine(n_pes), std::move(main), std::move(options));
}

}  // namespace tests
