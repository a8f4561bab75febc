// What a PE reports to the monitor: counters since the start of the run, and what is there now.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/pe/pe.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess::detail {

struct CollectionSample {
  CollectionId id{};
  std::string name;
  std::uint64_t n_local = 0;
};

/// An entry method: an estimate, from a window of a few milliseconds.
struct EntrySample {
  std::string name;
  double part = 0;  ///< of the PE's time
};

struct PeSample {
  PeId pe{};
  std::int64_t at_ns = 0;    ///< the PE's clock: wall time, or virtual time
  std::int64_t idle_ns = 0;  ///< how long it has been idle
  PeStatistics counts;
  std::uint64_t n_ready = 0;        ///< messages in its queue
  std::uint64_t n_epochs = 0;       ///< epochs that it keeps counters of
  std::uint64_t process_bytes = 0;  ///< memory of the process; only from the first PE of each
  PeLoad load;                      ///< that of elements only with --stats
  std::vector<CollectionSample> collections;
  std::vector<EntrySample> entries;  ///< that ran; only while a browser watches
  bool measured = false;             ///< `entries` are what a window has seen
};

/// The present sample of a PE, on its thread.
[[nodiscard]] PeSample sample_of(Pe& pe);

/// The program and the words of its command line, but the token, as JSON.
[[nodiscard]] std::string command_of_process();

}  // namespace tess::detail
