// A result that a coroutine waits for:
//
//     tess::Future<double> total;
//     blocks.broadcast<&Block::add>(total.callback());  // each calls contribute(tess::sum, x, target)
//     const double t = co_await total;
//
// The callback can be sent anywhere; the result arrives at the PE on which callback() was called
// first. It is taken once (a second co_await ends the job), and the future must outlive it: make it
// a local variable of the coroutine that awaits it, or a member of an element that does not migrate
// between callback() and co_await. Elsewhere in the process a check ends the job while the result
// is not there; to another process a future does not go along. A Future<void> gets no value.
//
// One line does the same, where the callback is the last argument of a broadcast:
//
//     const double t = co_await blocks.reduce<&Block::add>();
//
// The future's slot is in its PE's table, by number, from its first use until its result is there:
// the result is written there even if the future has gone to another PE meanwhile.
#pragma once

#include "runtime/callback.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/task.hpp"
#include "runtime/wire/messages/entry_traits.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace tess {

namespace detail {

/// What futures of all types have in common.
class FutureBase {
 public:
  FutureBase() = default;
  FutureBase(const FutureBase&) = delete;
  FutureBase& operator=(const FutureBase&) = delete;

  // when_all and when_any call these.
  void wait(Waiter& waiter);
  void withdraw() {
    if (slot_ != nullptr) slot_->waiting = nullptr;
  }

 protected:
  /// What the table knows. The thread of the PE writes it until `id` is 0.
  struct Slot {
    bool given = false;
    Waiter* waiting = nullptr;
    std::atomic<std::uint64_t> id = 0;  // the number in the table; 0: no PE knows it
  };
  using SlotPointer = std::unique_ptr<Slot, void (*)(Slot*)>;
  using MakeSlot = SlotPointer (*)();
  explicit FutureBase(MakeSlot make) : make_(make) {}
  ~FutureBase() { leave(); }

  /// The place of a result.
  struct Where {
    PeId pe;
    std::uint64_t id = 0;
  };
  [[nodiscard]] static Where where(std::span<const std::byte> name);
  [[nodiscard]] static std::string describe(std::span<const std::byte> name);
  /// The PE that sends a result there.
  [[nodiscard]] static Pe& sends_to(const Where& to);
  /// The slot of a result that arrives; `waits_for` is for errors.
  [[nodiscard]] static Slot& find(Pe& pe, std::uint64_t id, std::string_view value);
  /// Its result has been written.
  static void given(Pe& pe, Slot& slot);

  [[nodiscard]] Where name() const;
  [[nodiscard]] bool is_ready() const {
    if (is_expected()) require_here();  // the result may come meanwhile: decided once
    return slot_ != nullptr && slot_->given;
  }
  void start(Task::Handle task) {
    own_.start(task, 1);
    wait(own_);
  }
  void take_result(std::string_view value);
  void take(FutureBase& other);
  void replace(FutureBase& other);
  [[nodiscard]] Slot& slot() const { return *slot_; }
  [[nodiscard]] static std::string text_of(std::string_view value);

 private:
  [[nodiscard]] bool is_awaited() const { return slot_ != nullptr && slot_->waiting != nullptr; }
  /// True if a PE knows it.
  [[nodiscard]] bool is_expected() const {
    return slot_ != nullptr && slot_->id.load(std::memory_order_acquire) != 0;
  }
  /// From here on a result finds it, on this PE.
  void enter() const;
  /// Another thread runs the PE that knows it.
  void require_here() const;
  void leave();

  MakeSlot make_ = nullptr;
  mutable Pe* pe_ = nullptr;  // that knows the slot, or knew it
  mutable SlotPointer slot_{nullptr, nullptr};
  bool moved_ = false;  // to another future
  bool taken_ = false;  // a co_await has moved the value out
  Waiter own_;
};

}  // namespace detail

template <class T>
class Future : public detail::FutureBase {
  using Value = detail::ValueOrNone<T>;

 public:
  Future() : FutureBase(&make_slot) {
    static_assert(std::is_default_constructible_v<Value>,
                  "the value of a future needs a default constructor: where it arrives it is made "
                  "empty and then read");
  }
  /// A future moves on its own PE only, while no coroutine waits for it. The other can only be
  /// assigned to then.
  Future(Future&& other) noexcept : FutureBase(&make_slot) { take(other); }
  Future& operator=(Future&& other) noexcept {
    replace(other);
    return *this;
  }
  Future(const Future&) = delete;
  Future& operator=(const Future&) = delete;
  ~Future() = default;

  /// The target that receives the result.
  [[nodiscard]] Callback<T> callback() const {
    const Where to = name();
    return detail::make_target<Value>(kind_, std::in_place, to.pe, to.id);
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
  [[nodiscard]] bool await_ready() const { return is_ready(); }
  void await_suspend(Task::Handle task) {
    start(task);
    detail::suspend_on(task, *this);
  }
  T await_resume() {
    if constexpr (std::is_void_v<T>) {
      withdraw();
    } else {
      take_result(name_of_type<T>);
      return std::move(static_cast<TypedSlot&>(slot()).value);
    }
  }
  [[nodiscard]] static std::string waits_for() { return text_of(name_of_type<T>); }

 private:
  struct TypedSlot : Slot {
    Value value{};
  };
  static SlotPointer make_slot() {
    return {new TypedSlot, [](Slot* slot) { delete static_cast<TypedSlot*>(slot); }};
  }
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
    const Where to = where(callback.where());
    detail::send_system<&Future::arrives>(sends_to(to), to.pe, Result{to.id, std::move(value)});
  }
  static void arrives(Pe& pe, Result&& result, detail::Counted /*counted*/) {
    Slot& slot = find(pe, result.id, name_of_type<T>);
    static_cast<TypedSlot&>(slot).value = std::move(result.value);
    given(pe, slot);
  }
  static std::string describe(const Callback<Value>& callback) {
    return FutureBase::describe(callback.where());
  }
  static inline const typename Callback<Value>::Kind kind_{naming::name_of<&Future::give>(),
                                                           &Future::give, &Future::describe};
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

}  // namespace detail

}  // namespace tess
