// A result that a coroutine waits for:
//
//     tess::Future<double> total;
//     blocks.broadcast<&Block::add>(total.callback());  // each calls contribute(tess::sum, x, target)
//     const double t = co_await total;
//
// The callback can be sent anywhere; the result arrives at the PE on which callback() was called
// first. It is taken once (a second co_await ends the job), and the future must outlive it: make it
// a local variable of the coroutine that awaits it, or a member of an element that does not migrate
// between callback() and co_await. Elsewhere in the process a check ends the job while the result is
// not there; to another process a future does not go along. A Future<void> gets no value.
//
// The same in one line, where the callback is the last argument of a broadcast:
//
//     const double t = co_await blocks.reduce<&Block::add>();
//
// The future's slot is in its PE's table, by number, from its first use until its result is there: the
// result is written there even if the future has gone to another PE meanwhile, with its element.
#pragma once

#include "runtime/callback.hpp"
#include "runtime/core/check.hpp"
#include "runtime/messages/entry_traits.hpp"
#include "runtime/scheduler/pe_action.hpp"
#include "runtime/task.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
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
    TESS_CHECK(!is_awaited(), "a future is overwritten while a coroutine waits for it");
    leave();
    take(other);
    return *this;
  }
  ~Future() { leave(); }

  /// The target that receives the result.
  [[nodiscard]] Callback<T> callback() const {
    TESS_CHECK(!moved_, "a future that was moved from has no callback: use the one it moved to");
    enter();
    return detail::make_target<Value>(kind_, to_bytes(std::tuple(pe_->id(), slot_->id.load())));
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
  [[nodiscard]] bool await_ready() const {
    if (is_expected()) require_here();  // the result may come meanwhile: decided once
    return slot_ != nullptr && slot_->value.has_value();
  }
  void await_suspend(Task::Handle task) {
    own_.start(task, 1);
    wait(own_);
    suspend(task, [this] { return waits_for(); });
  }
  T await_resume() {
    withdraw();
    if constexpr (!std::is_void_v<T>) {
      TESS_CHECK(!std::exchange(taken_, true), waits_for(),
                 " is awaited again: the first co_await took its result, so keep that");
      return std::move(*slot_->value);
    }
  }

  // For when_all and when_any.
  void wait(detail::Waiter& waiter) {
    TESS_CHECK(!moved_, "a future that was moved from is awaited: await the one it moved to");
    TESS_CHECK(!is_awaited(), "two coroutines await one future");
    enter();
    slot_->waiting = &waiter;
  }
  void withdraw() {
    if (slot_ != nullptr) slot_->waiting = nullptr;
  }
  [[nodiscard]] static std::string waits_for() { return text("a future of ", name_of_type<T>); }

 private:
  /// What the table knows. The thread of the PE writes it until `id` is 0.
  struct Slot {
    std::optional<Value> value;
    detail::Waiter* waiting = nullptr;
    std::atomic<std::uint64_t> id = 0;  // the number in the table; 0: no PE knows it
  };
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
    auto* slot = static_cast<Slot*>(pe.require_future(result.id));
    TESS_CHECK(!slot->value, waits_for(), " was given two results: it takes one");
    slot->value = std::move(result.value);
    detail::Waiter* const waiter = slot->waiting;
    pe.leave_future(result.id);
    slot->id.store(0, std::memory_order_release);
    if (waiter != nullptr) waiter->wake();
    pe.completion().processed(pe.context().epoch);
  }
  static std::string describe(const Callback<Value>& callback) {
    const auto [pe, id] = from_bytes<std::tuple<PeId, std::uint64_t>>(callback.where());
    return text("future ", id, " of ", pe);
  }
  static inline const typename Callback<Value>::Kind kind_{naming::name_of<&Future::give>(),
                                                           &Future::give, &Future::describe};

  [[nodiscard]] bool is_awaited() const { return slot_ != nullptr && slot_->waiting != nullptr; }
  /// True if a PE knows it.
  [[nodiscard]] bool is_expected() const {
    return slot_ != nullptr && slot_->id.load(std::memory_order_acquire) != 0;
  }
  /// From here on a result finds it, on this PE.
  void enter() const {
    if (slot_ == nullptr) slot_ = std::make_unique<Slot>();
    if (!is_expected()) {
      pe_ = &current_pe();
      slot_->id = pe_->enter_future(slot_.get());
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
    if (!is_expected()) return;
    if (const Pe* const here = detail::current_pe_or_null(); here != pe_) [[unlikely]] {
      if (here == nullptr || here->stopped()) return;  // the run is over
      require_here();
    }
    pe_->leave_future(slot_->id);
  }
  void take(Future& other) {
    TESS_CHECK(!other.is_awaited(), "a future is moved while a coroutine waits for it");
    TESS_CHECK(!other.is_expected() || &current_pe() == other.pe_, "a future of ", other.pe_->id(),
               " is moved on ", current_pe().id(), ": send its callback() instead");
    moved_ = std::exchange(other.moved_, true);
    pe_ = other.pe_;
    slot_ = std::move(other.slot_);
    taken_ = other.taken_;
  }

  mutable Pe* pe_ = nullptr;  // that knows the slot, or knew it
  mutable std::unique_ptr<Slot> slot_;
  bool moved_ = false;  // to another future
  bool taken_ = false;  // a co_await has moved the value out
  detail::Waiter own_;
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
