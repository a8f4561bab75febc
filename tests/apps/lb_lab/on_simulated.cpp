#include "tests/apps/lb_lab/on_simulated.hpp"

#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <array>

namespace lb_lab {
namespace {

tess::Task fill(Sweep& sweep) {
  co_await run_all(sweep, 1e9);
}

}  // namespace

Sweep sweep_on(const std::string& options, Settings settings) {
  std::string program = "test", sim = "--sim=" + options;
  std::array<char*, 3> argv{program.data(), sim.data(), nullptr};
  int argc = 2;
  tess::Setup setup = tess::take_options(argc, argv.data());
  complete(settings, setup.machine->n_pes());
  Sweep sweep;
  sweep.settings = std::move(settings);
  REQUIRE(tess::run(setup, [&sweep] { return fill(sweep); }) == 0);
  return sweep;
}

}  // namespace lb_lab
