// The trace of a PE for --trace FILE: one slice per message that ran, with the send that caused it.
// It is kept in memory up to a limit per PE, and written at the end as JSON for Chrome's tracing
// page and Perfetto: one track per PE, and an arrow from each send to the slice that it caused.
// Without a trace the cost is one test of a null pointer per message.
#pragma once

#include "runtime/core/ids.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess::detail {

struct Action;

class Trace {
 public:
  explicit Trace(std::size_t most_records) : most_(most_records) {}

  /// Records the send of a message; returns its number, which the slice will refer to; never 0.
  [[nodiscard]] std::uint32_t sent(std::uint64_t at);
  /// A slice begins; ran() ends it.
  void begins() { in_slice_ = true; }
  /// Records the run of a message of `source` with the number that it has there (0: none).
  void ran(const Action* action, std::uint64_t begin, std::uint64_t end, PeId source,
           std::uint32_t number);

  /// Records an event of the program: a span, or a moment if it begins when it ends.
  void event(std::string name, std::uint64_t begin, std::uint64_t end);

  struct Slice {
    const Action* action = nullptr;
    std::uint64_t begin = 0, end = 0;  // in ticks of the PE's meter
    PeId source{};
    std::uint32_t number = 0;
  };
  struct Send {
    std::uint64_t at = 0;
    std::uint32_t number = 0;
    /// The slice that sent it; for one that is sent between two, the first; no_slice: before all.
    std::uint32_t slice = 0;
  };
  static constexpr std::uint32_t no_slice = ~std::uint32_t{0};
  struct Event {
    std::string name;
    std::uint64_t begin = 0, end = 0;
  };
  [[nodiscard]] const std::vector<Event>& events() const { return events_; }
  [[nodiscard]] const std::vector<Slice>& slices() const { return slices_; }
  [[nodiscard]] const std::vector<Send>& sends() const { return sends_; }
  /// The number of records that did not fit.
  [[nodiscard]] std::uint64_t n_dropped() const { return n_dropped_; }

 private:
  const std::size_t most_;
  std::uint32_t n_sent_ = 0;
  bool in_slice_ = false;
  std::uint64_t n_dropped_ = 0;
  std::vector<Slice> slices_;
  std::vector<Send> sends_;
  std::vector<Event> events_;
};

/// One PE's records and the clock of their times.
struct TraceOfPe {
  PeId pe{};
  const Trace* trace = nullptr;
  double seconds_per_tick = 0;
  std::uint64_t origin = 0;  ///< the reading at time 0
  double pause = 0;  ///< seconds: a longer one between two slices means that the PE was idle
};

/// Throws Error if the file cannot be written. Called before a run, not after it.
void require_writable_trace(const std::string& path);

/// Writes the records of a process's PEs. Throws Error if the file cannot be written.
void write_trace(const std::string& path, ProcessId process, const std::vector<TraceOfPe>& pes);

}  // namespace tess::detail
