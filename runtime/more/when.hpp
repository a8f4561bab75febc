// Waiting for several results at once: asks, futures, epochs, messages of mailboxes, and times.
// runtime.hpp does not include this header.
//
// Sample: tests/samples/ask.cpp
//
//     const auto [left, right] =
//         co_await tess::when_all(wells[{4}].ask<&Well::depth>(), wells[{6}].ask<&Well::depth>());
//     // …
//     const auto first = co_await tess::when_any(wells[{5}].ask<&Well::depth>(), tess::sleep(50ms));
//     if (first.index() == 0) found.in_time = std::get<0>(first);
//
// What is given as a variable stays usable: a future that comes second in when_any keeps its
// result. An ask that is made in the call is cancelled, a mailbox keeps its message, and an epoch
// goes on (its body does not run if another result is there already).
#pragma once

#include "runtime/callback.hpp"
#include "runtime/core/check.hpp"
#include "runtime/epoch.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/task.hpp"

#include <concepts>
#include <cstddef>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace tess {

/// A time to wait for: `co_await tess::sleep(5ms)`. It starts when it is made.
class [[nodiscard]] Sleep {
 public:
  explicit Sleep(Time delay) : pe_(&current_pe()), state_(std::make_shared<State>()) {
    timer_ = pe_->timers().after(delay, [state = state_] {
      state->over = true;
      if (state->waiting != nullptr) state->waiting->wake_at_end();  // exactly then
    });
  }
  Sleep(Sleep&& other) noexcept = default;
  Sleep(const Sleep&) = delete;
  Sleep& operator=(const Sleep&) = delete;
  Sleep& operator=(Sleep&&) = delete;
  ~Sleep() {
    if (state_ && !state_->over) pe_->timers().cancel(timer_);
  }

  [[nodiscard]] bool await_ready() const { return state_->over; }
  void await_suspend(Task::Handle task) {
    own_.start(task, 1);
    wait(own_);
    detail::suspend_on(task, *this);
  }
  void await_resume() const {}

  // when_all and when_any call these.
  void wait(detail::Waiter& waiter) {
    TESS_CHECK(state_->waiting == nullptr, "two coroutines await one sleep()");
    state_->waiting = &waiter;
  }
  void withdraw() { state_->waiting = nullptr; }
  [[nodiscard]] std::string waits_for() const { return "a time"; }

 private:
  struct State {
    bool over = false;
    detail::Waiter* waiting = nullptr;
  };
  Pe* pe_;
  std::uint64_t timer_ = 0;
  std::shared_ptr<State> state_;
  detail::Waiter own_;
};
[[nodiscard]] inline Sleep sleep(std::chrono::nanoseconds delay) {
  return Sleep(delay);
}

namespace detail {

template <class A>
concept Joinable = requires(std::remove_reference_t<A>& a, Waiter& waiter) {
  a.wait(waiter);
  a.withdraw();
  { a.await_ready() } -> std::same_as<bool>;
};

/// What an awaitable gives; NoValue for nothing.
template <class A>
using Awaited = decltype(std::declval<std::remove_reference_t<A>&>().await_resume());
template <class A>
using AwaitedValue = ValueOrNone<std::decay_t<Awaited<A>>>;
template <class A>
AwaitedValue<A> result_of(A& of) {
  if constexpr (std::is_void_v<Awaited<A>>) {
    of.await_resume();
    return {};
  } else {
    return of.await_resume();
  }
}

/// An epoch that is awaited with others. It begins when they are awaited.
template <class Body>
class JoinedEpoch {
 public:
  JoinedEpoch(EpochAwait<Body>&& epoch) : epoch_(std::move(epoch)) {}

  [[nodiscard]] bool await_ready() const { return state_ && state_->done; }
  [[nodiscard]] bool failed() const { return epoch_.failed(); }
  void await_resume() const { epoch_.await_resume(); }
  void wait(Waiter& waiter) {
    state_ = std::make_shared<State>(State{&waiter});
    epoch_.begin([state = state_] {
      state->done = true;
      if (state->waiting != nullptr) state->waiting->wake();
    });
  }
  void withdraw() {
    if (state_) state_->waiting = nullptr;
  }
  [[nodiscard]] std::string waits_for() const { return epoch_.waits_for(); }

 private:
  struct State {
    Waiter* waiting = nullptr;
    bool done = false;
  };
  EpochAwait<Body> epoch_;
  std::shared_ptr<State> state_;  // null until it begins
};
/// An awaitable that may give an error instead of a result.
template <class A>
bool has_failed(const A& part) {
  if constexpr (requires { part.failed(); }) {
    return part.failed();
  } else {
    return false;
  }
}

/// What when_all and when_any keep of an argument.
template <class A>
struct JoinAs : std::type_identity<A> {};
template <class Body>
struct JoinAs<EpochAwait<Body>> : std::type_identity<JoinedEpoch<Body>> {};
template <class... A>
class Parts;
template <class... A>
using PartsOf = Parts<typename JoinAs<A>::type...>;

inline void add_reason(WaitReason& all, const char* word, const WaitReason& one) {
  all.text += (all.text.empty() ? "" : word) + one.text;
}

/// Several awaitables: all or the first. Each calls a function with every part.
template <class... A>
class Parts {
 public:
  using All = std::tuple<AwaitedValue<A>...>;
  using First = std::variant<AwaitedValue<A>...>;
  explicit Parts(A&&... a) : parts_(std::forward<A>(a)...) {}
  [[nodiscard]] std::ptrdiff_t size() const { return sizeof...(A); }
  template <class Do>
  void each(const Do& run) {
    std::apply([&run](auto&... part) { (run(part), ...); }, parts_);
  }
  template <class Do>
  void each_backwards(const Do& run) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (run(std::get<sizeof...(A) - 1 - I>(parts_)), ...);
    }(std::index_sequence_for<A...>());
  }
  All all() {
    return std::apply([](auto&... part) { return All{result_of(part)...}; }, parts_);
  }
  First first(std::size_t which) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      std::optional<First> result;
      (void)((I == which
                  ? (result.emplace(std::in_place_index<I>, result_of(std::get<I>(parts_))), true)
                  : false) ||
             ...);
      return std::move(*result);
    }(std::index_sequence_for<A...>());
  }

 private:
  std::tuple<A...> parts_;
};

template <class A>
class PartsOfVector {
 public:
  using All = std::vector<AwaitedValue<A>>;
  struct First {
    std::size_t which = 0;
    AwaitedValue<A> value;
    [[nodiscard]] std::size_t index() const { return which; }
  };
  explicit PartsOfVector(std::vector<A>&& a) : parts_(std::move(a)) {}
  [[nodiscard]] std::ptrdiff_t size() const { return std::ssize(parts_); }
  template <class Do>
  void each(const Do& run) {
    for (A& part : parts_) run(part);
  }
  template <class Do>
  void each_backwards(const Do& run) {
    for (std::size_t n = parts_.size(); n > 0; --n) run(parts_[n - 1]);
  }
  All all() {
    All results;
    for (A& part : parts_) results.push_back(result_of(part));
    return results;
  }
  First first(std::size_t which) { return {which, result_of(parts_[which])}; }

 private:
  std::vector<A> parts_;
};

/// Withdraws the parts that are `unused`, the last one first: what each has taken of a mailbox is
/// again the oldest message of its key. Only then are these messages given to others that wait.
template <class P, class Unused>
void withdraw(P& parts, const Unused& unused) {
  parts.each_backwards([&unused](auto& part) {
    if (unused(part)) part.withdraw();
  });
  parts.each([&unused](auto& part) {
    if constexpr (requires { part.pass_on(); })
      if (unused(part)) part.pass_on();
  });
}

template <class P>
class [[nodiscard]] WhenAll {
 public:
  explicit WhenAll(P parts) : parts_(std::move(parts)) {}
  [[nodiscard]] bool await_ready() {
    bool ready = true;
    parts_.each([&ready](auto& part) { ready = part.await_ready() && ready; });
    return ready;
  }
  void await_suspend(Task::Handle task) {
    waiter_.start(task, parts_.size());
    suspend_on(task, *this);
    // An epoch begins now: what it does may be what another part waits for.
    parts_.each([this](auto& part) {
      if (part.await_ready()) {
        waiter_.wake();
      } else {
        part.wait(waiter_);
      }
    });
  }
  typename P::All await_resume() {
    bool failed = false;
    parts_.each([&failed](const auto& part) { failed = failed || has_failed(part); });
    if (failed) {
      withdraw(parts_, [](const auto& part) { return !has_failed(part); });
      parts_.each([](auto& part) {
        if (has_failed(part)) (void)part.await_resume();  // throws
      });
    }
    return parts_.all();
  }
  [[nodiscard]] WaitReason waits_for() {
    WaitReason all("");
    parts_.each([&all](auto& part) {
      if (part.await_ready()) return;
      const WaitReason one = part.waits_for();
      add_reason(all, " and ", one);
      all.asked.insert(all.asked.end(), one.asked.begin(), one.asked.end());
    });
    return all;
  }

 private:
  P parts_;
  Waiter waiter_;
};

template <class P>
class [[nodiscard]] WhenAny {
 public:
  explicit WhenAny(P parts) : parts_(std::move(parts)) {}
  [[nodiscard]] bool await_ready() { return find() != none; }
  void await_suspend(Task::Handle task) {
    waits_ = true;
    waiter_.start(task, 1);
    suspend_on(task, *this);
    bool ready = false;  // by the body of an epoch that began before it
    parts_.each([&](auto& part) {
      if (ready) return;
      ready = part.await_ready();
      if (ready) {
        waiter_.wake();
      } else {
        part.wait(waiter_);
      }
    });
  }
  typename P::First await_resume() {
    const std::size_t which = find();
    if (waits_) {
      const void* used = nullptr;
      std::size_t i = 0;
      parts_.each([&](const auto& part) {
        if (i++ == which) used = &part;
      });
      withdraw(parts_, [used](const auto& part) { return &part != used; });
    }
    return parts_.first(which);
  }
  [[nodiscard]] WaitReason waits_for() {
    WaitReason all("");  // it needs no one of the elements that it asks
    parts_.each([&all](auto& part) { add_reason(all, " or ", part.waits_for()); });
    return all;
  }

 private:
  static constexpr std::size_t none = ~std::size_t{0};
  /// The first that is ready.
  [[nodiscard]] std::size_t find() {
    std::size_t i = 0, found = none;
    parts_.each([&](auto& part) {
      if (found == none && part.await_ready()) found = i;
      ++i;
    });
    return found;
  }

  P parts_;
  Waiter waiter_;
  bool waits_ = false;
};

template <class A>
inline constexpr bool is_vector_variable = false;
template <class A>
inline constexpr bool is_vector_variable<std::vector<A>&> = true;
template <class A>
inline constexpr bool is_vector_variable<const std::vector<A>&> = true;

template <class... A>
consteval bool check_joined() {
  static_assert(!(is_vector_variable<A> || ...),
                "a vector is moved in: when_all(std::move(vector)), when_any(std::move(vector))");
  static_assert((Joinable<typename JoinAs<A>::type> && ...),
                "when_all and when_any take asks, futures, epochs, mailbox.take(…) and "
                "tess::sleep(…); when_all also a vector of tasks");
  return true;
}

}  // namespace detail

/// When awaited, gives all results, as a tuple; NoValue for what has none. Once all are there, the
/// first error is thrown, and the others stay where they are: a mailbox keeps its message, a future
/// its result.
template <class... A>
[[nodiscard]] auto when_all(A&&... a) {
  static_assert(detail::check_joined<A...>());
  return detail::WhenAll<detail::PartsOf<A...>>(detail::PartsOf<A...>(std::forward<A>(a)...));
}
/// Awaits a vector likewise, and gives a vector.
template <class A>
[[nodiscard]] auto when_all(std::vector<A>&& a) {
  static_assert(detail::check_joined<A>());
  return detail::WhenAll<detail::PartsOfVector<A>>(detail::PartsOfVector<A>(std::move(a)));
}
namespace detail {
inline Task await_each(std::vector<Task> tasks) {
  std::exception_ptr error;
  for (Task& task : tasks) {
    try {
      co_await task;
    } catch (...) {
      if (!error) error = std::current_exception();
    }
  }
  if (error) std::rethrow_exception(error);
}
template <class T>
TaskOf<std::vector<T>> await_each(std::vector<TaskOf<T>> tasks) {
  std::vector<T> values;
  std::exception_ptr error;
  for (TaskOf<T>& task : tasks) {
    try {
      T value = co_await task;
      values.push_back(std::move(value));
    } catch (...) {
      if (!error) error = std::current_exception();
    }
  }
  if (error) std::rethrow_exception(error);
  co_return values;
}
}  // namespace detail
/// Awaits all tasks, also if one fails, and then throws the first error.
inline Task when_all(std::vector<Task>&& tasks) {
  return detail::await_each(std::move(tasks));
}
/// Awaits tasks that give values, and gives a vector of these.
template <class T>
TaskOf<std::vector<T>> when_all(std::vector<TaskOf<T>>&& tasks) {
  return detail::await_each(std::move(tasks));
}
/// When awaited, gives the first result, as a variant whose index() says which one it is. If
/// several are there, it is the first in the order of the arguments.
template <class... A>
[[nodiscard]] auto when_any(A&&... a) {
  static_assert(detail::check_joined<A...>());
  return detail::WhenAny<detail::PartsOf<A...>>(detail::PartsOf<A...>(std::forward<A>(a)...));
}
/// Awaits the first of a vector, which is not empty; gives {which, value}.
template <class A>
[[nodiscard]] auto when_any(std::vector<A>&& a) {
  static_assert(detail::check_joined<A>());
  TESS_CHECK(!a.empty(), "when_any() of an empty vector has no first result: give at least one");
  return detail::WhenAny<detail::PartsOfVector<A>>(detail::PartsOfVector<A>(std::move(a)));
}

}  // namespace tess
