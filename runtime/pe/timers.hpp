// The timers of one PE. A timer that runs once counts as a message of its epoch: it is sent when
// the timer is set and processed when it has run or is cancelled, so its epoch and the run wait for
// it.
//
// The timers wait here, each with the message that runs it once it is due. Only an alarm for the
// earliest of them is with the machine, and so a timer that is cancelled leaves nothing behind:
//
//     after, every   the timer waits; if it is earlier than all alarms: one more alarm
//     alarm          the messages of all that are due go into the queue of this PE
//
// A periodic timer belongs to no epoch, and neither epochs nor the run wait for its next tick. What
// a tick sends is counted in epoch 0. So that the run does not end while such a message is under
// way, the timers are frozen while PE 0 takes the census of a quiescent run:
//
//     wave: quiescent, S messages sent  ->  each PE: freeze, answer with its number of messages sent
//     all answers: sum = S  no PE has sent anything since, and none will: the run is over
//                  sum > S  a tick has sent something: thaw, and check again
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace tess::detail {

class Pe;
struct Envelope;

class Timers {
 public:
  using Call = std::function<void()>;

  explicit Timers(Pe& pe);
  Timers(const Timers&) = delete;
  Timers& operator=(const Timers&) = delete;
  ~Timers();

  /// Calls `call` on this PE after the delay, in the current epoch, unless the timer is cancelled
  /// before; returns its number.
  std::uint64_t after(Time delay, Call call);
  /// Calls `call` on this PE after each period, until the timer is cancelled; returns its number.
  std::uint64_t every(Time period, Call call);
  /// `call` is not called again. No effect on a timer that has run or was cancelled.
  void cancel(std::uint64_t timer);

  /// The greatest number that a timer of this PE has.
  [[nodiscard]] std::uint64_t n_made() const { return n_made_; }
  /// The numbers of new timers are greater than this one: those of the run that a restart goes on
  /// with name none.
  void begin_behind(std::uint64_t number) { n_made_ = number > n_made_ ? number : n_made_; }

  /// No tick runs until thaw().
  void freeze();
  void thaw();

  /// The number of timers that run once and have not run yet.
  [[nodiscard]] std::size_t n_waiting() const;
  [[nodiscard]] std::size_t n_periodic() const;

  /// Forgets all timers that wait, without running them: the run is over.
  void drop_all();

  // Handlers of the messages.
  void on_alarm(Time at);
  void on_due(std::uint64_t timer);
  void on_tick(std::uint64_t timer);

 private:
  void set_tick(std::uint64_t timer, Time due);
  void wait(std::uint64_t timer, Time due, Envelope* message);
  void stop_waiting(std::uint64_t timer, Time due);
  void set_alarm();

  Pe& pe_;
  std::uint64_t n_made_ = 0;
  struct Tables;
  const std::unique_ptr<Tables> tables_;
};

/// Cancels a timer of any PE: on this PE at once, on another soon.
void cancel_timer(PeId pe, std::uint64_t timer);

}  // namespace tess::detail
