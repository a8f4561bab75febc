#include "apps/bench/calibrate/calibrate.hpp"

#include "apps/bench/calibrate/fit.hpp"
#include "apps/kit/output/write_file.hpp"
#include "runtime/core/error.hpp"
#include "runtime/wire/machine/simulated.hpp"

#include <algorithm>
#include <fmt/core.h>
#include <fstream>
#include <iterator>

namespace bench {
namespace {

std::string contents(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

tess::SimulatedOptions two_pes(Joins joins, const tess::Wire& wire) {
  tess::SimulatedOptions options;
  options.n_pes = 2;
  options.pes_per_process = joins == Joins::pes ? 2 : 1;
  options.latency = wire.latency;
  options.bandwidth = wire.bandwidth;
  options.overhead = wire.overhead;
  options.process_copy = wire.copy;
  return options;
}

void show(const char* what, double measured, double simulated) {
  tess::print(fmt::format("{:<34} {:>10.0f} {:>10.0f}\n", what, measured, simulated));
}

}  // namespace

void require_calibration(const std::string& path, const tess::Machine& machine) {
  if (machine.virtual_time())
    tess::fail(tess::ErrorCode::bad_argument, "--calibrate ", path,
               " measures this machine, not a simulated one: leave out --sim");
  if (machine.n_pes() != 2)
    tess::fail(tess::ErrorCode::bad_argument, "--calibrate ", path, ": ", machine.n_pes(),
               machine.n_pes() == 1 ? " PE" : " PEs",
               ", but it takes two: start it as bench --pes 2, and as mpirun -n 2 bench --pes 1");
  tess::SimulatedOptions before;
  if (std::ifstream(path)) tess::read_simulated_file(path, before);
}

int calibrate(const Bench& bench, const std::string& path) {
  const WireEffort effort{bench.size(15, 1), bench.size(1000, 20)};
  WireTimes measured;
  if (const int code = bench.run([&] { return measure_wire(effort, measured); }); code != 0)
    return code;
  if (!bench.speaks()) return 0;
  const Joins joins = bench.ranks() > 1 ? Joins::processes : Joins::pes;
  int code = 0;
  const WireEffort less{bench.size(5, 1), effort.n_rounds};
  const FittedWire fitted = fit_wire(measured, [&](const tess::Wire& wire) {
    WireTimes times;
    tess::Setup setup;
    setup.machine = tess::make_simulated_machine(two_pes(joins, wire));
    code = std::max(code, tess::run(setup, [&] { return measure_wire(less, times); }));
    return times;
  });
  if (code != 0) return code;
  tess::print(fmt::format("{:<34} {:>10} {:>10}\n", "ns", "measured", "simulated"));
  show("a number, one way", measured.ping, fitted.simulated.ping);
  if (measured.large > 0) show("256 KiB, one way", measured.large, fitted.simulated.large);
  show("a message sent and one received", measured.exchange, fitted.simulated.exchange);
  if (measured.exchange_packed > 0)
    show("the same with 8 KiB", measured.exchange_packed, fitted.simulated.exchange_packed);
  const std::string before = contents(path);
  kit::write_file(path, wire_file(joins, fitted.wire, bench.origin().machine, before));
  tess::print(path, ":\n", contents(path));
  return 0;
}

}  // namespace bench
