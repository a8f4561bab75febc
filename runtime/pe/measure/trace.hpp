// The trace of a PE for --trace FILE: one slice per message that ran, with the send that caused it.
// It is kept in memory up to a limit per PE, and at the end of the run process 0 gets those of all
// PEs and writes one file, as JSON for Chrome's tracing page and Perfetto: one track per PE, a slice
// per message that ran code of the user, and a send of no duration, from which an arrow leads to the
// slice. Messages of the runtime have slices named "runtime", joined where no pause is between them,
// and no arrows. So the file has at most two events per message. Without a trace the cost is one
// test of a null pointer per message.
#pragma once

#include "runtime/core/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tess::detail {

class Trace {
 public:
  Trace() = default;
  explicit Trace(std::size_t most_records) : most_(most_records) {}

  /// Records the send of a message; returns its number, which the slice will refer to; never 0.
  [[nodiscard]] std::uint32_t sent(std::uint64_t at);
  /// A slice begins; ran() ends it.
  void begins() { in_slice_ = true; }
  /// Records the run of a message of `source` with the number that it has there (0: none).
  /// `action`: the number of the entry method that ran first.
  void ran(std::uint32_t action, std::uint64_t begin, std::uint64_t end, PeId source,
           std::uint32_t number);

  /// Records an event of the program: a span, or a moment if it begins when it ends.
  void event(std::string name, std::uint64_t begin, std::uint64_t end);

  struct Slice {
    std::uint64_t begin = 0, end = 0;  // in ticks of the PE's meter
    std::uint32_t action = 0;
    PeId source{};
    std::uint32_t number = 0;
    std::uint32_t unused = 0;  // without padding it is packed as bytes
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
  /// The send of this number; null if it is not among the records.
  [[nodiscard]] const Send* send_of(std::uint32_t number) const {
    const std::size_t at = std::size_t{number} - 1;
    return number != 0 && at < sends_.size() && sends_[at].number == number ? &sends_[at] : nullptr;
  }
  /// The number of records that did not fit.
  [[nodiscard]] std::uint64_t n_dropped() const { return n_dropped_; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_dropped_, slices_, sends_, events_);
  }

 private:
  std::size_t most_ = 0;
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
  ProcessId process{};
  double late = 0;  ///< seconds that the clock of its process is behind that of process 0

  [[nodiscard]] double seconds(std::uint64_t ticks) const {
    return seconds_per_tick * (static_cast<double>(ticks) - static_cast<double>(origin)) + late;
  }
};

/// Sets `late` of the PEs of other processes, by their messages from and to process 0: in both
/// directions the fastest takes the same time. All PEs of the run, in order.
void align_clocks(std::vector<TraceOfPe>& pes);

/// "Block::step" for what the user wrote, "main program", or "runtime".
[[nodiscard]] std::string trace_name(std::uint32_t action);

/// Throws Error if the file cannot be written. Called before a run, not after it.
void require_writable_trace(const std::string& path);

/// Writes the records of all PEs. Throws Error if the file cannot be written.
void write_trace(const std::string& path, const std::vector<TraceOfPe>& pes);

}  // namespace tess::detail
