#include "apps/bench/calibrate/fit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <sstream>
#include <string_view>

namespace bench {
namespace {

constexpr double most_bandwidth = 1e12;
constexpr int n_corrections = 4;

tess::Time whole_nanoseconds(double nanoseconds) {
  return tess::Time(std::llround(nanoseconds));
}

/// Parameters that are corrected, in nanoseconds.
struct Guess {
  double overhead = 0, latency = 0;
  double per_byte = 0;       // under way
  double copy_per_byte = 0;  // of CPU time, of each end, unless a message travels alone in place

  [[nodiscard]] tess::Wire wire() const {
    return {whole_nanoseconds(latency), std::min(most_bandwidth, 1e9 / std::max(1e-12, per_byte)),
            whole_nanoseconds(overhead), copy_per_byte > 0 ? 1e9 / copy_per_byte : 0};
  }
};

/// True of a line about the wire between processes: a key, or the comment above the keys.
bool is_between(std::string_view line) {
  return line.starts_with("process-") || line.starts_with("# Between processes");
}

constexpr std::string_view head =
    "# Parameters of the simulated machine, found by bench --calibrate: --sim file=FILE,pes=8\n";

}  // namespace

FittedWire fit_wire(const WireTimes& measured, const SimulateWire& simulate) {
  Guess guess;
  FittedWire result{guess.wire(), simulate(guess.wire())};
  for (int i = 0; i < n_corrections; ++i) {
    const WireTimes& is = result.simulated;
    const double overhead = guess.overhead;
    guess.overhead = std::max(0.0, overhead + (measured.exchange - is.exchange) / 2);
    // The overhead of both ends is part of the way.
    guess.latency =
        std::max(0.0, guess.latency + (measured.ping - is.ping) - 2 * (guess.overhead - overhead));
    if (measured.large > 0) {
      guess.per_byte =
          std::max(0.0, guess.per_byte + ((measured.large - measured.ping) - (is.large - is.ping)) /
                                             static_cast<double>(large_bytes));
      const double lacks =
          (measured.exchange_packed - measured.exchange) - (is.exchange_packed - is.exchange);
      guess.copy_per_byte =
          std::max(0.0, guess.copy_per_byte + lacks / (2 * static_cast<double>(packed_bytes)));
    }
    result.wire = guess.wire();
    result.simulated = simulate(result.wire);
  }
  return result;
}

std::string wire_file(Joins joins, const tess::Wire& wire, const std::string& note,
                      const std::string& before) {
  const bool between = joins == Joins::processes;
  const std::string prefix = between ? "process-" : "";
  std::string mine = fmt::format("# {}: {}\n{}latency={}ns\n{}overhead={}ns\n",
                                 between ? "Between processes" : "Within a process", note, prefix,
                                 wire.latency.count(), prefix, wire.overhead.count());
  if (between) {
    mine += fmt::format("{}bandwidth={:.3f}GB/s\n", prefix, wire.bandwidth / 1e9);
    if (wire.copy > 0) mine += fmt::format("{}copy={:.3f}GB/s\n", prefix, wire.copy / 1e9);
  }
  std::string others;
  std::istringstream lines(before);
  for (std::string line; std::getline(lines, line);)
    if (is_between(line) != between && line + "\n" != head) others += line + "\n";
  return std::string(head) + (between ? others + mine : mine + others);
}

}  // namespace bench
