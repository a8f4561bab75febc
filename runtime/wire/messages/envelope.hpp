// A message: its action, its epoch, its source, and behind them the typed arguments. Within a
// process the pointer travels; between processes the action packs the arguments.
//
//     | Link | action | epoch | source target | typed arguments … |
//
// An envelope belongs to one queue or one function at a time. The function that ends its life calls
// discard().
#pragma once

#include "runtime/base/link.hpp"
#include "runtime/core/ids.hpp"
#include "runtime/core/registry.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <atomic>
#include <cstdint>

namespace tess::detail {

class TessElement;
using Element = TessElement;
class Pe;
struct Action;

struct Envelope : Link {
  const Action* action = nullptr;
  Element* receiver = nullptr;  ///< a hint for prefetching; null if unknown
  EpochId epoch{};
  PeId source{};
  PeId target{};
  bool counted = true;       ///< in epoch 0; false for messages that measure or end the run
  bool prioritised = false;  ///< its action gives its priority, which is not 0
  /// The number of its send on the source PE, if a trace is kept; with an audit the number of its
  /// hop (report/audit.hpp).
  std::uint32_t trace = 0;
  static constexpr std::uint32_t most_trace = (1U << 29) - 1;  // so many travel between processes
  /// Credit that the PE that runs it owes to `sender`, which packed it for this hop (outbox.hpp); 0
  /// within a process.
  std::uint32_t charge = 0;
  PeId sender{};  ///< also the PE that sent this hop, with an audit
};

/// The action of an envelope when its turn comes. One static object for each kind of message.
struct Action : Registered {
  using Run = void (*)(Pe&, Envelope*);
  using Destroy = void (*)(Envelope*);
  using Pack = void (*)(Envelope&, Writer&);
  using Unpack = Envelope* (*)(Pe&, Reader&);
  using PriorityOf = std::int64_t (*)(const Envelope&);
  using CarriedBy = const Action& (*)(const Envelope&);

  Action(naming::Name name, Run run_, Destroy destroy_, Pack pack_, Unpack unpack_,
         Traffic traffic_, PriorityOf priority_of_ = nullptr, CarriedBy carried_by_ = nullptr)
      : Registered(name),
        run(run_),
        destroy(destroy_),
        pack(pack_),
        unpack(unpack_),
        traffic(traffic_),
        priority_of(priority_of_),
        carried_by(carried_by_) {}

  /// The duration of its messages as known in this process: a message that may be slow must not
  /// delay earlier messages to other PEs.
  enum class Pace : std::uint8_t { unknown, quick, slow };
  [[nodiscard]] bool quick() const {
    return pace_.load(std::memory_order_relaxed) ==
           Pace::quick;  // only a hint: correctness does not depend on it
  }
  void set_pace(Pace pace) const {
    if (pace_.load(std::memory_order_relaxed) != pace) pace_.store(pace, std::memory_order_relaxed);
  }

  Run run;          ///< on the target PE's thread; takes ownership of the envelope
  Destroy destroy;  ///< destroys the arguments and frees the block
  Pack pack;
  Unpack unpack;
  Traffic traffic;
  PriorityOf priority_of;  ///< null if none of its messages is prioritised
  CarriedBy carried_by;    ///< the user's call in it, for reports; null if there is none

 private:
  mutable std::atomic<Pace> pace_{Pace::unknown};
};

/// Releases a message that will not run again.
inline void discard(Envelope* message) {
  message->action->destroy(message);
}

}  // namespace tess::detail
