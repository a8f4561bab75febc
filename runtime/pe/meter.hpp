// Measures what the code of a PE costs, by element and entry method. A PE has a meter only if a
// balancer, a trace or statistics request it; without one, a call of an entry method costs one test
// of a null pointer.
//
// Scopes nest (a constructor inside a handler); time counts for the innermost scope. It is read
// from the cycle counter, which continues while the kernel runs another thread. So after each call
// that ends a millisecond or more after the last time (a quantum) the PE's thread reads its CPU
// time. What its steps took beyond that was stolen by other threads and is no busy time; it is also
// subtracted from the longest call of the quantum, since a preempted call is long. On the simulated
// machine the meter reads the virtual clock, from which no time is stolen.
//
//   step_begins  [ enter … [ enter … leave ] … leave ]*  step_ends   idle …
#pragma once

#include "runtime/base/ticks.hpp"
#include "runtime/core/element_key.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace tess::detail {

class Pe;
struct Action;
struct LoadRecord;

class ScopeListener;

class Meter {
 public:
  Meter(Machine& machine, PeId pe);

  /// The running scope: the record that gets its time (null: none) and its entry method.
  struct Scope {
    LoadRecord* record = nullptr;
    const Action* action = nullptr;
  };

  [[nodiscard]] std::uint64_t now() const {
    return virtual_ ? static_cast<std::uint64_t>(machine_.now(pe_).count()) : read_ticks();
  }
  [[nodiscard]] double seconds(std::uint64_t ticks) const {
    return static_cast<double>(ticks) * seconds_per_tick_;
  }
  [[nodiscard]] std::uint64_t ticks(double seconds) const {
    return static_cast<std::uint64_t>(seconds / seconds_per_tick_);
  }

  /// Begins a scope; returns the one that it interrupts, for leave().
  [[nodiscard]] Scope enter(Scope scope) {
    const std::uint64_t at = pass();
    if (watched_ != nullptr) watch_enters(scope.action);
    if (listener_ != nullptr) [[unlikely]]
      tell(at);
    if (entered_ == nullptr) entered_ = scope.action;
    return std::exchange(scope_, scope);
  }
  /// The entry method of the first scope since forget_entered(); null if there was none.
  [[nodiscard]] const Action* entered() const { return entered_; }
  void forget_entered() { entered_ = nullptr; }
  void leave(Scope outer) {
    const std::uint64_t at = pass();
    if (watched_ != nullptr) watch_leaves();
    if (listener_ != nullptr) [[unlikely]]
      tell(at);
    if (at - quantum_began_ > quantum_ticks_) [[unlikely]]
      quantum_passes(at);  // a step may be long: a broadcast to all elements is one
    const Scope ended = std::exchange(scope_, outer);
    if (at >= alarm_at_ && is_balanced(ended.record)) [[unlikely]]
      ring(at);
  }
  /// True if the sizes of sent messages are to be measured, by packing them, for the running
  /// record.
  [[nodiscard]] bool weighs_messages() const { return is_balanced(scope_.record); }
  /// The running element sends a payload to another element.
  void sent(const ElementKey& to, std::uint64_t bytes);
  /// The record ends or leaves this PE, with a balancer or without: after a restart it may have
  /// none.
  void forget(const LoadRecord* record) {
    if (scope_.record == record) scope_.record = nullptr;
    if (longest_.record == record) longest_ = {};
  }

  /// From now on each scope is shown to the watch of this PE, with the element of its context.
  void show_to(Pe& pe) { watched_ = &pe; }
  /// From now on the listener is called for each scope; null: none is. Not owned.
  void set_listener(ScopeListener* listener) { listener_ = listener; }

  /// Ticks of the elements of all balanced arrays here; each balancer adds the sum of its own,
  /// which it counts up until it removes it.
  [[nodiscard]] std::uint64_t in_balanced() const;
  void add_balanced(const std::uint64_t* sum) { balanced_.push_back(sum); }
  void remove_balanced(const std::uint64_t* sum);

  // The PE calls these.
  void step_begins();
  void step_ends();
  void idle();

  /// Ticks in steps that ran a message, without stolen time.
  [[nodiscard]] std::uint64_t busy() const { return busy_; }
  /// Adds the step that runs now to them. Called in a step.
  [[nodiscard]] std::uint64_t busy_until_now() const { return busy_ + (now() - step_began_); }
  /// Ticks in scopes with a record.
  [[nodiscard]] std::uint64_t in_records() const { return in_records_; }
  /// Seconds since the meter was made.
  [[nodiscard]] double age() const { return seconds(now() - made_); }
  [[nodiscard]] std::uint64_t made() const { return made_; }

  /// From now on `ring` is called after a scope with a record that ends at least `period` ticks
  /// after the last call. (The consequences of a call have no record, so they do not trigger
  /// another.) The owner removes the alarm before its own end.
  void add_alarm(std::uint64_t period, const void* owner, std::function<void()> ring);
  void remove_alarms(const void* owner);

 private:
  /// True for the record of an element that a balancer watches.
  [[nodiscard]] static bool is_balanced(const LoadRecord* record);
  void tell(std::uint64_t at) const;
  void watch_enters(const Action* action);
  void watch_leaves();
  /// Adds the time since the last change of scope to the running scope; returns the present time.
  std::uint64_t pass();
  void ring(std::uint64_t at);
  void begin_quantum();
  void end_quantum();
  void quantum_passes(std::uint64_t at);

  Machine& machine_;
  const PeId pe_;
  const bool virtual_;
  const double seconds_per_tick_;
  const std::uint64_t made_;
  Scope scope_;
  const Action* entered_ = nullptr;
  std::uint64_t since_ = 0;  // the last change of scope
  std::uint64_t step_began_ = 0;
  std::uint64_t busy_ = 0;
  std::uint64_t in_records_ = 0;

  // The quantum: its start, the CPU time at its start, and its longest call.
  const std::uint64_t quantum_ticks_, gap_ticks_;
  std::uint64_t quantum_began_ = 0, busy_at_begin_ = 0;
  double cpu_at_begin_ = std::numeric_limits<double>::quiet_NaN();  // until the first begins
  std::uint64_t last_seen_ = 0;
  Scope longest_;
  std::uint64_t longest_ticks_ = 0;

  struct Alarm {
    std::uint64_t period = 0;
    std::uint64_t at = 0;
    const void* owner = nullptr;
    std::function<void()> ring;
  };
  Pe* watched_ = nullptr;
  ScopeListener* listener_ = nullptr;
  std::vector<const std::uint64_t*> balanced_;
  std::uint64_t balanced_before_ = 0;  // the sums that were removed
  std::vector<Alarm> alarms_;
  std::uint64_t alarm_at_ = ~std::uint64_t{0};  // the earliest alarm
};

}  // namespace tess::detail
