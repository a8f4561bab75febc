// What disturbs the order of messages on a simulated machine, message by message, and asks a PE in
// the middle of its work to report its counters. Without one, a machine with a seed draws the
// disorder itself. The machine carries a message that is not delayed
// in a fixed time, and messages that arrive at the same time in the order of sending, so a run
// whose adversary delays nothing is the plain run.
#pragma once

#include "runtime/base/link.hpp"
#include "runtime/core/ids.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <cstddef>
#include <span>

namespace tess::detail {

/// A message that the machine is about to carry: a pointer within a process, bytes between two.
struct Sending {
  PeId from;
  PeId to;                     ///< of bytes: the first PE of the receiving process
  const Link* link = nullptr;  ///< null: the message is bytes
  std::span<const std::byte> bytes;
  Time due{};  ///< when it arrives if it is not delayed
};

class Adversary {
 public:
  Adversary() = default;
  Adversary(const Adversary&) = delete;
  Adversary& operator=(const Adversary&) = delete;
  virtual ~Adversary() = default;

  /// How much later than due the message arrives; not negative.
  virtual Time delay(const Sending& sending) = 0;
  /// True if the PE, which is about to take a step, is asked for its counters first.
  virtual bool interrupts(PeId /*pe*/) { return false; }
};

}  // namespace tess::detail
