// Timers: messages that arrive after a time.
//
//     using namespace std::chrono_literals;
//     tess::after(5ms, [blocks] { blocks[{0}].send<&Block::look>(1); });
//     tess::after(5ms, blocks[{0}].target<&Block::look>(), 1);       // the same
//     blocks[{0}].send_after<&Block::look>(5ms, 1);                  // the same
//     const tess::Timer timer = tess::every(1s, [log] { log.local().print(); });
//     timer.cancel();
//
// The function runs on the PE that set the timer, as a message of its own: it must not hold `this`
// or a reference to an element, which may move or end meanwhile. It runs once the time is over and
// the PE is free. On the simulated machine times are virtual.
#pragma once

#include "runtime/callback.hpp"
#include "runtime/core/duration.hpp"
#include "runtime/pe/pe.hpp"

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace tess {

namespace detail {
template <class F>
consteval bool check_timer_call() {
  static_assert(std::is_void_v<std::invoke_result_t<F&>>,
                "the function of a timer returns void: to start a coroutine, send a message");
  static_assert(std::is_copy_constructible_v<F>, "the function of a timer is copyable");
  return true;
}
}  // namespace detail

/// A timer, as a value: it can be stored, sent, and used on every PE.
class Timer {
 public:
  Timer() = default;
  Timer(PeId pe, std::uint64_t number) : pe_(pe), number_(number) {}

  /// Ends the timer. On its own PE it is never called again; from another PE it may be called until
  /// this request arrives. The epoch of a timer that runs once no longer waits for it. Cancelling
  /// it again, or a timer that has run, or one of the run before a restart, or a Timer() that names
  /// none, has no effect. (One of an earlier run() may name a timer of this one.)
  void cancel() const {
    if (number_ != 0) detail::cancel_timer(pe_, number_);
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(pe_, number_);
  }
  friend bool operator==(const Timer&, const Timer&) = default;

 private:
  PeId pe_{};
  std::uint64_t number_ = 0;
};

/// Calls `call` once, after the delay. The timer is a message of the current epoch: the epoch and
/// the run do not end before the call and all that it causes are done, or the timer is cancelled.
template <class F>
  requires std::invocable<F&>
Timer after(std::chrono::nanoseconds delay, F call) {
  static_assert(detail::check_timer_call<F>());
  Pe& pe = current_pe();
  return {pe.id(), pe.timers().after(delay, std::move(call))};
}
/// Calls a target with a value, once, after the delay.
template <class T>
Timer after(std::chrono::nanoseconds delay, Callback<T> target, std::type_identity_t<T> value) {
  return after(delay, [target = std::move(target), value = std::move(value)] { target(value); });
}

/// Calls `call` after each period, until the timer is cancelled or the run ends. A call that comes
/// late replaces those that it missed. The timer belongs to no epoch, and nothing waits for its
/// next call: an epoch ends, and the run ends or reports a deadlock, as if there were no such
/// timer. What a call sends belongs to the run and to no other epoch: the run does not end before
/// it is done. (A run in which each call starts work that lasts longer than the period ends by
/// exit().)
template <class F>
  requires std::invocable<F&>
Timer every(std::chrono::nanoseconds period, F call) {
  static_assert(detail::check_timer_call<F>());
  Pe& pe = current_pe();
  return {pe.id(), pe.timers().every(period, std::move(call))};
}
/// Calls a target with a value after each period.
template <class T>
Timer every(std::chrono::nanoseconds period, Callback<T> target, std::type_identity_t<T> value) {
  return every(period, [target = std::move(target), value = std::move(value)] { target(value); });
}

}  // namespace tess
