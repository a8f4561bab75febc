// One run of a program on a machine of a test, in one call:
//
//     CHECK(tests::run("pes=3,cost=100ns", main).exit_code == 0);
//     CHECK(tests::run_threads(2, main).report == "");
//
// A machine that delays messages and shrinks what fails is tess::test::Machine.
#pragma once

#include "runtime/core/error.hpp"
#include "runtime/core/text.hpp"
#include "runtime/run.hpp"
#include "runtime/task.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"

#include <array>
#include <memory>
#include <string>
#include <utility>

namespace tests {

/// How a run ended.
struct Ending {
  int exit_code = 0;
  std::string report;  ///< what the runtime would have printed to standard error, lines
};

/// Runs `main` on PE 0 of this machine, to the end of the run.
template <class Main>
Ending run_on(std::unique_ptr<tess::Machine> machine, Main main,
              tess::RuntimeOptions options = {}) {
  Ending ending;
  options.report = [&ending](const std::string& line) { ending.report += line + "\n"; };
  tess::Setup setup{std::move(machine), std::move(options)};
  ending.exit_code = tess::run(setup, std::move(main));
  return ending;
}

/// Does the same on the simulated machine that the keys describe, as those of --sim do. What they
/// say about migrations is left to the options; the work that a cost leaves out is not reported,
/// since it depends on the load of the host.
template <class Main>
Ending run(const std::string& keys, Main main, tess::RuntimeOptions options = {}) {
  tess::SimulatedOptions machine = tess::parse_simulated(keys);
  machine.watches_cost = false;
  return run_on(tess::make_simulated_machine(machine), std::move(main), std::move(options));
}

/// The same on threads of this process.
template <class Main>
Ending run_threads(int n_pes, Main main, tess::RuntimeOptions options = {}) {
  return run_on(tess::make_threads_machine(n_pes), std::move(main), std::move(options));
}

/// The message of the Error that ends the coroutine `main` on a simulated machine: empty if it ends
/// well, and the report if the run fails otherwise.
template <class Main>
std::string error_of(const std::string& keys, Main main) {
  std::string message;
  const auto catching = [&]() -> tess::Task {
    try {
      (void)co_await main();
    } catch (const tess::Error& error) {
      message = error.what();
    }
  };
  const Ending ending = run(keys, catching);
  return ending.exit_code == 0 ? message : ending.report;
}

/// The machine that an option of a program describes: "--pes=2", "--sim=pes=4,seed=1".
inline tess::Setup setup_of(std::string option) {
  std::string name = "test";
  std::array<char*, 3> argv{name.data(), option.data(), nullptr};
  int argc = 2;
  return tess::take_options(argc, argv.data());
}

}  // namespace tests
