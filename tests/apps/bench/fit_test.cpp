// The parameters that bench --calibrate finds, from machines whose times are known formulas, and
// the file that it writes.
#include "apps/bench/calibrate/fit.hpp"

#include "tests/support/catch.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace {

using bench::WireTimes;
using tess::Time;
using tess::Wire;

double nanoseconds(Time time) {
  return static_cast<double>(time.count());
}

/// A machine whose own code takes `own` ns for a ball and for an exchange, beside its wire.
WireTimes formula(const Wire& wire, double own) {
  const double way = own + nanoseconds(wire.latency) + 2 * nanoseconds(wire.overhead);
  const double exchange = own + 2 * nanoseconds(wire.overhead);
  const double copy = wire.copy > 0 ? 2e9 / wire.copy : 0;  // ns per byte, of both ends
  return {way, way + 3 * own + static_cast<double>(bench::large_bytes) * 1e9 / wire.bandwidth,
          exchange, exchange + own + static_cast<double>(bench::packed_bytes) * copy};
}

/// A file that the test writes.
struct Scratch {
  std::string path =
      (std::filesystem::temp_directory_path() / ("tess_fit_" + std::to_string(::getpid()) + ".sim"))
          .string();
  void write(const std::string& content) const { std::ofstream(path) << content; }
  ~Scratch() { std::remove(path.c_str()); }
};

}  // namespace

TEST_CASE("the fitted parameters are those of the measured machine", "[bench]") {
  const Wire wire{Time(800), 5e9, Time(130), 8e9};
  const auto simulate = [](const Wire& guess) { return formula(guess, 45); };
  const bench::FittedWire fitted = bench::fit_wire(formula(wire, 45), simulate);
  CHECK(fitted.wire.latency == wire.latency);
  CHECK(fitted.wire.overhead == wire.overhead);
  CHECK(fitted.wire.bandwidth == Approx(wire.bandwidth).epsilon(1e-6));
  CHECK(fitted.wire.copy == Approx(wire.copy).epsilon(1e-6));
  CHECK(fitted.simulated.ping == Approx(formula(wire, 45).ping));
}

TEST_CASE("copies of packed messages may take longer per byte than a large message", "[bench]") {
  const Wire wire{Time(300), 4e9, Time(90), 3.5e9};
  const auto simulate = [](const Wire& guess) { return formula(guess, 45); };
  const bench::FittedWire fitted = bench::fit_wire(formula(wire, 45), simulate);
  CHECK(fitted.wire.bandwidth == Approx(wire.bandwidth).epsilon(1e-6));
  CHECK(fitted.wire.copy == Approx(wire.copy).epsilon(1e-6));
}

TEST_CASE("what the simulation costs itself is no part of the parameters", "[bench]") {
  // The simulation's code takes twice as long as the machine's: less is left for the wire.
  const Wire wire{Time(800), 5e9, Time(130), 8e9};
  const bench::FittedWire fitted =
      bench::fit_wire(formula(wire, 40), [](const Wire& guess) { return formula(guess, 80); });
  CHECK(fitted.wire.overhead == Time(110));
  CHECK(fitted.wire.latency == wire.latency);

  // A simulation that is slower in all: nothing is left, and nothing is negative.
  const bench::FittedWire none =
      bench::fit_wire(formula({Time(0), 1e12, Time(0), 0}, 40),
                      [](const Wire& guess) { return formula(guess, 4000); });
  CHECK(none.wire.overhead == Time(0));
  CHECK(none.wire.latency == Time(0));
  CHECK(none.wire.copy == 0);
}

TEST_CASE("a file of parameters keeps those of the other wire and is read by --sim", "[bench]") {
  const Scratch file;
  using bench::Joins;
  const Wire within{Time(120), 10e9, Time(35), 0}, between{Time(900), 4.5e9, Time(250), 6e9};
  std::string text = bench::wire_file(Joins::pes, {Time(1), 1e9, Time(2), 0}, "first", "");
  text = bench::wire_file(Joins::processes, between, "two processes", text);
  text = bench::wire_file(Joins::pes, within, "two PEs", text);
  CHECK(text == bench::wire_file(Joins::pes, within, "two PEs", text));
  CHECK(text.find("first") == std::string::npos);
  file.write(text);

  const auto options = tess::parse_simulated("file=" + file.path + ",pes=6,per-process=3");
  CHECK(options.n_pes == 6);
  CHECK(options.within_process().latency == within.latency);
  CHECK(options.within_process().overhead == within.overhead);
  CHECK(options.between_processes().latency == between.latency);
  CHECK(options.between_processes().overhead == between.overhead);
  CHECK(options.between_processes().bandwidth == Approx(between.bandwidth));
  CHECK(options.between_processes().copy == Approx(between.copy));
}
