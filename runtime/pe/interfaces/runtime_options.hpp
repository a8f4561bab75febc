// Options of a run that the program, the command line or a test sets.
#pragma once

#include "runtime/core/duration.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace tess::detail {

class ElementMover;

/// Options of messages between processes.
struct MessageOptions {
  std::size_t attach_bytes = std::size_t{16}
                             << 10;  ///< a vector of this size or more is attached as a part
  std::size_t memory_bytes = std::size_t{32}
                             << 20;  ///< most bytes under way from one process to another
};

/// A live view of the run for a web browser.
struct MonitorOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: any free one
  std::string token;       ///< every request must bring it; empty only on a loopback address
  std::int64_t period_ms = 500;
};

/// For tests of the audit: something that goes wrong with one message that a PE sends to another.
struct MessageFault {
  enum class Kind : std::uint8_t { none, lost, twice };
  Kind kind = Kind::none;
  std::uint64_t nth = 0;  ///< of the users' messages that PE 0 sends to other PEs, from 1
};

struct RuntimeOptions {
  std::uint64_t seed = 0;
  double migration_chance = 0;  ///< probability of a forced migration after a message, for testing
  ElementMover* mover = nullptr;  ///< if present: it chooses the forced migrations. Not owned.
  bool statistics = false;        ///< print the counters of each PE
  MessageOptions messages;
  std::optional<MonitorOptions> monitor;
  std::string trace;  ///< the file of the trace; empty: no trace
  /// Reports what waits when no entry method has begun for this time; 0: never. Virtual time on the
  /// simulated machine.
  std::chrono::nanoseconds hang_report{0};
  bool audit = false;  ///< count the messages between PEs at both ends and compare
  MessageFault fault;  ///< needs `audit`
  /// Takes SIGINT, SIGTERM and SIGUSR1, where the program has left them to the system.
  bool signals = true;
  /// Receives the lines of reports (deadlock, exception, statistics); if empty, they go to standard
  /// error.
  std::function<void(const std::string&)> report;
};

}  // namespace tess::detail

namespace tess {

using detail::MessageFault;
using detail::MessageOptions;
using detail::MonitorOptions;
using detail::RuntimeOptions;

}  // namespace tess
