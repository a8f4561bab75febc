// The parameters of a simulated machine, as --sim and the file of `bench --calibrate` give them.
//
//     --sim pes=8,latency=2us,cost=100ns       --sim here.sim,pes=8     a file, and parts after it
//
// A message to another PE takes the sender `overhead`, is under way for latency + bytes /
// bandwidth, and takes the receiver `overhead` again. Between processes a transfer of packed
// messages does the same with parameters of its own, and its bytes are copied by both; those of a
// large vector, which is received in place, are not.
#pragma once

#include "runtime/wire/machine/machine.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace tess::detail {

class Adversary;

/// What joins two PEs.
struct Wire {
  Time latency{1000};
  double bandwidth = 10e9;  ///< bytes per second
  Time overhead{0};         ///< CPU time of a message, of the sender and again of the receiver
  /// Bytes per second of CPU time, of the sender and again of the receiver; 0: free.
  double copy = 0;
};

/// The seeds of a search for a race: a run each, which prints the same as in the plain order.
struct SeedRange {
  std::uint64_t first = 1, last = 0;
  std::string compare{};  ///< only lines with this text are compared
};

struct SimulatedOptions {
  std::int32_t n_pes = 4;
  std::int32_t pes_per_process = 0;  ///< 0: one process, or drawn from the seed if there is one
  // Between PEs of a process, as Wire.
  Time latency{1000};
  double bandwidth = 10e9;
  Time overhead{0};
  // Between processes; absent: as within one.
  std::optional<Time> process_latency;
  std::optional<double> process_bandwidth;
  std::optional<Time> process_overhead;
  double process_copy = 0;
  std::optional<Time> cost;           ///< cost of one message; absent: measured
  bool watches_cost = false;          ///< report the work that a cost leaves out, as --sim does
  std::optional<std::uint64_t> seed;  ///< if present: adversarial order
  /// After each message; absent: 0, or drawn from the seed.
  std::optional<double> migration_chance;
  // A run that needs more is stopped as a livelock. 0: no bound.
  std::uint64_t most_events = 0;
  Time most_time{};  ///< virtual
  /// If present: it chooses the disorder, and the seed only the processes. Not owned.
  Adversary* adversary = nullptr;
  std::optional<SeedRange> seeds{};  ///< of --sim seeds=1..200

  [[nodiscard]] Wire within_process() const { return {latency, bandwidth, overhead, 0}; }
  [[nodiscard]] Wire between_processes() const {
    return {process_latency.value_or(latency), process_bandwidth.value_or(bandwidth),
            process_overhead.value_or(overhead), process_copy};
  }
};

/// "pes=8,latency=2us,bandwidth=10GB/s,cost=100ns,per-process=2,migrate=0.1,seed=7". A part without
/// "=", or file=F, is a file of parameters; parts after it override it. Throws Error that names the
/// part, or the file and line.
[[nodiscard]] SimulatedOptions parse_simulated(const std::string& text);

/// Takes the parameters of a file: a line "key=value" for each, and lines that begin with "#".
/// Throws Error that names the file and line.
void read_simulated_file(const std::string& path, SimulatedOptions& options);

/// The probability of a forced migration after a message: as given, or drawn from the seed.
[[nodiscard]] double migration_chance(const SimulatedOptions& options);

}  // namespace tess::detail

namespace tess {

using detail::parse_simulated;
using detail::read_simulated_file;
using detail::SimulatedOptions;
using detail::Wire;

}  // namespace tess
