// A machine with any number of PEs, simulated in one thread as a sequential discrete-event
// simulation. Each PE has a virtual clock. Running a message advances it by the measured time or by
// a fixed cost (with which a run repeats bit for bit); a message arrives after latency + bytes /
// bandwidth.
//
// With a seed the machine is adversarial: messages arrive in any order, some kinds of traffic are
// slow throughout, and a PE is asked to report its counters in the middle of its work. Every choice
// is drawn from the seed, so a failure repeats. A test may bring an adversary of its own.
#pragma once

#include "runtime/machine/machine.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace tess::detail {

class Adversary;

struct SimulatedOptions {
  std::int32_t n_pes = 4;
  std::int32_t pes_per_process = 0;  ///< 0: one process, or drawn from the seed if there is one
  Time latency{1000};
  double bandwidth = 10e9;            ///< bytes per second
  std::optional<Time> cost;           ///< cost of one message; absent: measured
  std::optional<std::uint64_t> seed;  ///< if present: adversarial order
  /// After each message; absent: 0, or drawn from the seed.
  std::optional<double> migration_chance;
  // A run that needs more is stopped as a livelock. 0: no bound.
  std::uint64_t most_events = 0;
  Time most_time{};  ///< virtual
  /// If present: it chooses the disorder, and the seed only the processes. Not owned.
  Adversary* adversary = nullptr;
};

/// "pes=8,latency=2us,bandwidth=10GB/s,cost=100ns,per-process=2,migrate=0.1,seed=7". Throws Error
/// that names the part.
[[nodiscard]] SimulatedOptions parse_simulated(const std::string& text);

/// The probability of a forced migration after a message: as given, or drawn from the seed.
[[nodiscard]] double migration_chance(const SimulatedOptions& options);

[[nodiscard]] std::unique_ptr<Machine> make_simulated_machine(const SimulatedOptions& options);

}  // namespace tess::detail

namespace tess {

using detail::make_simulated_machine;
using detail::parse_simulated;
using detail::SimulatedOptions;

}  // namespace tess
