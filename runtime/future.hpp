// A result that a coroutine waits for:
//
//     tess::Future<double> total;
//     blocks.broadcast<&Block::add>(total.callback());  // each calls contribute(tess::sum, x, target)
//     const double t = co_await total;
//
// The callback can be sent anywhere; the result arrives at the PE on which callback() was called
// first. It is taken once (a second co_await ends the job), and the future must outlive it: make it
// a local variable of the coroutine that awaits it, or a member of an element that does not migrate
// between callback() and the arrival of the result (a check ends the job otherwise). A Future<void>
// gets no value.
//
// The same in one line, where the callback is the last argument of a broadcast:
//
//     const double t = co_await blocks.reduce<&Block::add>();
//
// The future is in its PE's table, by number, from its first use until its result is there.
#pragma once

#include "runtime/callback.hpp"
#include "runtime/core/check.hpp"
#include "runtime/messages/entry_traits.hpp"
#include "runtime/scheduler/pe_action.hpp"
#include "runtime/task.hpp"

#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

namespace tess {

template <class T>
class Future {
  using Value = detail::ValueOrNone<T>;

 public:
  Future() {
    static_assert(std::is_default_constructible_v<Value>,
                  "the value of a future needs a default constructor: where it arrives it is made "
                  "empty and then read");
  }
  Future(const Future&) = delete;
  Future& operator=(const Future&) = delete;
  /// Not while a coroutine waits for it, and on its own PE only. The other can only be assigned to.
  Future(Future&& other) noexcept { take(other); }
  Future& operator=(Future&& other) noexcept {
    if (this == &other) return *this;
    TESS_CHECK(waiting_ == nullptr, "a future is overwritten while a coroutine waits for it");
    leave();
    take(other);
    return *this;
  }
  ~Future() { leave(); }

  /// The target that receives the result.
  [[nodiscard]] Callback<T> callback() const {
    TESS_CHECK(!moved_, "a future that was moved from has no callback: use the one it moved to");
    enter();
    return detail::make_target<Value>(kind_, to_bytes(std::tuple(pe_->id(), id_)));
  }

  /// Awaits a variable where it is: g++ 12 would copy an operand that is a call, as futures[i].
  [[nodiscard]] auto operator co_await() {
    struct InPlace {
      Future& of;
      [[nodiscard]] bool await_ready() const { return of.await_ready(); }
      void await_suspend(Task::Handle task) const { of.await_suspend(task); }
      T await_resume() const { return of.await_resume(); }
    };
    return InPlace{*this};
  }
  [[nodiscard]] bool await_ready() const { return value_.has_value(); }
  void await_suspend(Task::Handle task) {
    own_.start(task, 1);
    wait(own_);
    suspend(task, [this] { return waits_for(); });
  }
  T await_resume() {
    waiting_ = nullptr;
    if constexpr (!std::is_void_v<T>) {
      TESS_CHECK(!std::exchange(taken_, true), waits_for(),
                 " is awaited again: the first co_await took its result, so keep that");
      return std::move(*value_);
    }
  }

  // For when_all and when_any.
  void wait(detail::Waiter& waiter) {
    TESS_CHECK(!moved_, "a future that was moved from is awaited: await the one it moved to");
    TESS_CHECK(waiting_ == nullptr, "two coroutines await one future");
    enter();
    waiting_ = &waiter;
  }
  void withdraw() { waiting_ = nullptr; }
  [[nodiscard]] std::string waits_for() const { return text("a future of ", name_of_type<T>); }

 private:
  struct Result {
    std::uint64_t id = 0;
    Value value{};
    using GivesMembers = void;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(id, value);
    }
  };
  static void give(const Callback<Value>& callback, Value&& value) {
    const auto [pe, id] = from_bytes<std::tuple<PeId, std::uint64_t>>(callback.where());
    Pe& here = current_pe();
    if (pe.value >= here.n_pes()) (void)here.require_future(0);
    here.completion().sent(here.context().epoch);
    detail::send_system<&Future::arrives>(here, pe, Result{id, std::move(value)});
  }
  static void arrives(Pe& pe, Result&& result) {
    auto* future = static_cast<Future*>(pe.require_future(result.id));
    TESS_CHECK(!future->value_, future->waits_for(), " was given two results: it takes one");
    future->value_ = std::move(result.value);
    pe.leave_future(std::exchange(future->id_, 0));
    if (future->waiting_ != nullptr) future->waiting_->wake();
    pe.completion().processed(pe.context().epoch);
  }
  static std::string describe(const Callback<Value>& callback) {
    const auto [pe, id] = from_bytes<std::tuple<PeId, std::uint64_t>>(callback.where());
    return text("future ", id, " of ", pe);
  }
  static inline const typename Callback<Value>::Kind kind_{naming::name_of<&Future::give>(),
                                                           &Future::give, &Future::describe};

  /// From here on a result finds it, on this PE.
  void enter() const {
    if (id_ == 0) {
      pe_ = &current_pe();
      id_ = pe_->enter_future(const_cast<Future*>(this));
    }
    require_here();
  }
  /// Another thread runs the PE that knows it.
  void require_here() const {
    TESS_CHECK(pe_ == &current_pe(), "a future of ", pe_->id(), " is used on ", current_pe().id(),
               ": its element has migrated before its result was there; make it a local variable "
               "of the coroutine that awaits it, or migrate after that");
  }
  void leave() {
    if (id_ == 0) return;
    if (const Pe* const here = detail::current_pe_or_null(); here != pe_) [[unlikely]] {
      if (here == nullptr || here->stopped()) return;  // the run is over
      require_here();
    }
    pe_->leave_future(std::exchange(id_, 0));
  }
  void take(Future& other) {
    TESS_CHECK(other.waiting_ == nullptr, "a future is moved while a coroutine waits for it");
    TESS_CHECK(other.id_ == 0 || &current_pe() == other.pe_, "a future of ", other.pe_->id(),
               " is moved on ", current_pe().id(), ": send its callback() instead");
    moved_ = std::exchange(other.moved_, true);
    pe_ = other.pe_;
    id_ = std::exchange(other.id_, 0);
    value_ = std::exchange(other.value_, std::nullopt);
    taken_ = other.taken_;
    if (id_ != 0) pe_->move_future(id_, this);
  }

  mutable Pe* pe_ = nullptr;      // that knows it
  mutable std::uint64_t id_ = 0;  // its number there; 0: no PE knows it
  bool moved_ = false;            // to another future
  std::optional<Value> value_;
  bool taken_ = false;  // a co_await has moved the value out
  detail::Waiter own_;
  detail::Waiter* waiting_ = nullptr;
};

namespace detail {

/// The type of value that the last parameter of an entry method is a target for.
template <class Parameters>
struct LastTarget {
  static constexpr bool exists = false;
};
template <class T>
struct LastTarget<std::tuple<Callback<T>>> {
  static constexpr bool exists = true;
  using Value = T;
};
template <class First, class Second, class... Others>
struct LastTarget<std::tuple<First, Second, Others...>>
    : LastTarget<std::tuple<Second, Others...>> {};

template <auto F>
consteval auto reduced_value() {
  if constexpr (!EntryTraits<F>::is_member) {
    static_assert(EntryTraits<F>::is_member,
                  "an entry method is a member function: reduce<&Class::function>(…)");
    return std::type_identity<void>();
  } else {
    using Target = LastTarget<typename EntryTraits<F>::Arguments>;
    static_assert(Target::exists,
                  "reduce() gives the entry method a target for the result: its last parameter is "
                  "a tess::Callback<T>");
    if constexpr (Target::exists) {
      return std::type_identity<typename Target::Value>();
    } else {
      return std::type_identity<void>();
    }
  }
}

/// The future of what entry method F is given a target for.
template <auto F>
using FutureOf = Future<typename decltype(reduced_value<F>())::type>;

/// The reduce() of all proxies that broadcast.
template <auto F, class Proxy, class... Args>
[[nodiscard]] FutureOf<F> reduce(const Proxy& all, Args&&... args) {
  FutureOf<F> result;
  all.template broadcast<F>(std::forward<Args>(args)..., result.callback());
  return result;
}

}  // namespace detail

}  // namespace tess
