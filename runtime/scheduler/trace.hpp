// What a PE did when, for --trace FILE: one slice a message that ran, with the send that caused it.
// Kept in memory, at most so many a PE, and written at the end as the JSON that Chrome's tracing
// page and Perfetto read: a track a PE, an arrow from each send to the slice it caused. Off, it
// costs one test of a null pointer a message.
#pragma once

#include "runtime/core/ids.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess {

struct Action;

class Trace {
 public:
  explicit Trace(std::size_t most_records) : most_(most_records) {}

  /// A message is sent: the number that its slice will name, never 0.
  [[nodiscard]] std::uint32_t sent(std::uint64_t at);
  /// A message of `source`, with the number that it was given there (0: none), has run.
  void ran(const Action* action, std::uint64_t begin, std::uint64_t end, PeId source,
           std::uint32_t number);

  struct Slice {
    const Action* action = nullptr;
    std::uint64_t begin = 0, end = 0;  // ticks of the PE's meter
    PeId source{};
    std::uint32_t number = 0;
  };
  struct Send {
    std::uint64_t at = 0;
    std::uint32_t number = 0;
  };
  [[nodiscard]] const std::vector<Slice>& slices() const { return slices_; }
  [[nodiscard]] const std::vector<Send>& sends() const { return sends_; }
  /// What found no room any more.
  [[nodiscard]] std::uint64_t n_dropped() const { return n_dropped_; }

 private:
  const std::size_t most_;
  std::uint32_t n_sent_ = 0;
  std::uint64_t n_dropped_ = 0;
  std::vector<Slice> slices_;
  std::vector<Send> sends_;
};

/// One PE's records and the clock they were taken with.
struct TraceOfPe {
  PeId pe{};
  const Trace* trace = nullptr;
  double seconds_per_tick = 0;
  std::uint64_t origin = 0;  ///< ticks at time 0
};

/// Throws Error where the file cannot be written: before a run, not after it.
void require_writable_trace(const std::string& path);

/// Writes the records of a process's PEs. Throws Error where the file cannot be written.
void write_trace(const std::string& path, ProcessId process, const std::vector<TraceOfPe>& pes);

}  // namespace tess
