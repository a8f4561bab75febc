#include "tests/apps/lb_lab/on_simulated.hpp"

#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

namespace lb_lab {
namespace {

tess::Task fill(Sweep& sweep) {
  co_await run_all(sweep, 1e9);
}

}  // namespace

Sweep sweep_on(const std::string& options, Settings settings) {
  tess::Setup setup = tests::setup_of("--sim=" + options);
  complete(settings, setup.machine->n_pes());
  Sweep sweep;
  sweep.settings = std::move(settings);
  REQUIRE(tess::run(setup, [&sweep] { return fill(sweep); }) == 0);
  return sweep;
}

}  // namespace lb_lab
