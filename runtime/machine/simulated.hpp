// A machine of any number of PEs, simulated in one thread: a sequential discrete-event simulation.
// Each PE has a virtual clock, which running a message advances by its measured time or by a fixed
// cost (then a run repeats bit for bit); a message arrives after latency + bytes / bandwidth.
//
// With a seed it is an adversary: messages arrive in any order, kinds of traffic are slow as a
// whole, a PE is asked to tell its counters in the middle of its work. Every choice is drawn from
// the seed, so a failure repeats.
#pragma once

#include "runtime/machine/machine.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace tess {

struct SimulatedOptions {
  std::int32_t n_pes = 4;
  std::int32_t pes_per_process = 0;  ///< 0: one process of all; with a seed: drawn from it
  Time latency{1000};
  double bandwidth = 10e9;            ///< bytes a second
  std::optional<Time> cost;           ///< of one message; absent: measured
  std::optional<std::uint64_t> seed;  ///< present: adversarial order
  std::optional<double>
      migration_chance;           ///< after each message; absent: 0, or drawn from the seed
  std::uint64_t most_events = 0;  ///< 0: no bound; a run that needs more is stopped as a livelock
};

/// "pes=8,latency=2us,bandwidth=10GB/s,cost=100ns,per-process=2,migrate=0.1,seed=7". Throws Error
/// that names the part.
[[nodiscard]] SimulatedOptions parse_simulated(const std::string& text);

/// The migration chance of these options: given, or drawn from the seed.
[[nodiscard]] double migration_chance(const SimulatedOptions& options);

[[nodiscard]] std::unique_ptr<Machine> make_simulated_machine(const SimulatedOptions& options);

}  // namespace tess
