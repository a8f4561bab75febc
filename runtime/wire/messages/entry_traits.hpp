// The properties of an entry method: its class, its arguments as values, and whether it is a
// coroutine. Also the messages that the compiler prints if a member function cannot be one.
#pragma once

#include "runtime/core/check.hpp"

#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

namespace tess {

class Task;
template <class T>
class TaskOf;

template <class... Parameters>
struct Overload {
  template <class C, class R>
  constexpr auto operator()(R (C::*function)(Parameters...)) const {
    return function;
  }
};
/// The entry method of these parameters among several of one name:
/// send<tess::overload<int>(&Block::set)>(3).
template <class... Parameters>
inline constexpr Overload<Parameters...> overload{};

}  // namespace tess

namespace tess::detail {

template <class F>
struct MemberTraits {
  static constexpr bool is_member = false;
};
template <class R, class C, class... P>
struct MemberTraits<R (C::*)(P...)> {
  static constexpr bool is_member = true;
  using Result = R;
  using Class = C;
  using Arguments = std::tuple<std::decay_t<P>...>;
  static constexpr std::size_t n_arguments = sizeof...(P);
  static constexpr bool by_value = (!std::is_reference_v<P> && ...);
  static constexpr bool by_value_or_const =
      ((!std::is_lvalue_reference_v<P> || std::is_const_v<std::remove_reference_t<P>>)&&...);
};
template <class R, class C, class... P>
struct MemberTraits<R (C::*)(P...) const> : MemberTraits<R (C::*)(P...)> {};
template <class R, class C, class... P>
struct MemberTraits<R (C::*)(P...) noexcept> : MemberTraits<R (C::*)(P...)> {};
template <class R, class C, class... P>
struct MemberTraits<R (C::*)(P...) const noexcept> : MemberTraits<R (C::*)(P...)> {};

template <auto F>
using EntryTraits = MemberTraits<decltype(F)>;

/// What a function of this result type gives in the end: void for Task, T for TaskOf<T>.
template <class Result>
struct GivenBy : std::type_identity<Result> {
  static constexpr bool is_task = false;
};
template <>
struct GivenBy<Task> : std::type_identity<void> {
  static constexpr bool is_task = true;
};
template <class T>
struct GivenBy<TaskOf<T>> : std::type_identity<T> {
  static constexpr bool is_task = true;
};

/// True if the type To cannot hold every number of type From: 3.7 as an integer, a double as a
/// float, a 64-bit number as one of 32 bits. (Signs are checked when the number is sent.)
template <class To, class From>
inline constexpr bool loses_digits =
    std::is_arithmetic_v<To> && std::is_arithmetic_v<From> && !std::is_same_v<To, bool> &&
    (std::is_floating_point_v<To> ? std::is_floating_point_v<From> && sizeof(To) < sizeof(From)
                                  : std::is_floating_point_v<From> || sizeof(To) < sizeof(From));

template <class Parameters, class... Args>
consteval bool loses() {
  return []<class... P>(std::tuple<P...>*) {
    return (loses_digits<P, std::remove_cvref_t<Args>> || ...);
  }(static_cast<Parameters*>(nullptr));
}

/// An argument as the entry method's parameter takes it. A number below zero for an unsigned
/// parameter, or one above the largest of a signed one, is misuse.
template <class P, class A>
decltype(auto) as_parameter(A&& argument) {
  using From = std::remove_cvref_t<A>;
  if constexpr (std::is_integral_v<P> && std::is_integral_v<From> && !std::is_same_v<P, bool> &&
                !std::is_same_v<From, bool> && std::is_signed_v<P> != std::is_signed_v<From>) {
    const P sent = static_cast<P>(argument);
    TESS_CHECK((sent < P{}) == (argument < From{}), "an argument is ", argument,
               ", but the entry method takes ", std::numeric_limits<P>::min(), " to ",
               std::numeric_limits<P>::max());
    return sent;
  } else {
    return std::forward<A>(argument);
  }
}

/// The arguments of an entry method as its message carries them.
template <class Parameters, class... Args>
[[nodiscard]] Parameters as_parameters(Args&&... args) {
  return [&]<class... P>(std::tuple<P...>*) {
    return Parameters(as_parameter<P>(std::forward<Args>(args))...);
  }(static_cast<Parameters*>(nullptr));
}

/// Checks that F is a member function of C that can be called with these arguments.
template <class C, auto F, class... Args>
consteval bool check_call() {
  using Traits = EntryTraits<F>;
  static_assert(Traits::is_member,
                "an entry method is a member function: send<&Class::function>(…)");
  if constexpr (Traits::is_member) {
    static_assert(
        std::is_base_of_v<typename Traits::Class, C>,
        "this entry method belongs to another class than the elements of this collection");
    static_assert(Traits::by_value_or_const,
                  "an entry method takes its arguments by value or const reference");
    static_assert(std::is_default_constructible_v<typename Traits::Arguments>,
                  "the arguments of an entry method need default constructors: where they arrive "
                  "they are made empty and then read");
    static_assert(!GivenBy<typename Traits::Result>::is_task || Traits::by_value,
                  "a coroutine takes its arguments by value: the message is gone once it waits");
    if constexpr (sizeof...(Args) == Traits::n_arguments) {
      static_assert(std::is_constructible_v<typename Traits::Arguments, Args...>,
                    "these arguments are not what the entry method takes");
      static_assert(!loses<typename Traits::Arguments, Args...>(),
                    "an argument would lose digits: give a number of the entry method's type, or "
                    "convert it where you send");
    } else {
      static_assert(sizeof...(Args) == Traits::n_arguments,
                    "these are more or fewer arguments than the entry method takes");
    }
  }
  return true;
}

/// Checks that F is an entry method of C that can be called with these arguments.
template <class C, auto F, class... Args>
consteval bool check_entry() {
  if constexpr (EntryTraits<F>::is_member) {
    using Result = typename EntryTraits<F>::Result;
    static_assert(
        std::is_void_v<Result> || std::is_same_v<Result, Task>,
        "an entry method returns void or tess::Task; ask<&C::f>() calls a function that returns "
        "a value");
  }
  return check_call<C, F, Args...>();
}

/// The same for a broadcast to elements.
template <class C, auto F, class... Args>
consteval bool check_broadcast() {
  static_assert(std::is_copy_constructible_v<typename EntryTraits<F>::Arguments>,
                "each element gets a copy of a broadcast's arguments, so they can be copied");
  return check_entry<C, F, Args...>();
}

/// Checks that F is a member function of C whose reply can be awaited.
template <class C, auto F, class... Args>
consteval bool check_ask() {
  if constexpr (EntryTraits<F>::is_member) {
    using Result = typename GivenBy<typename EntryTraits<F>::Result>::type;
    static_assert(std::is_void_v<Result> || std::is_same_v<Result, std::decay_t<Result>>,
                  "a reply is a value: a function that is asked returns no reference");
    static_assert(std::is_void_v<Result> || std::is_default_constructible_v<Result>,
                  "a reply needs a default constructor: where it arrives it is made empty and then "
                  "read");
  }
  return check_call<C, F, Args...>();
}

/// The type of value that a target of entry method F takes: its argument, or `Without`.
template <auto F, class Without>
consteval auto target_value() {
  using Traits = EntryTraits<F>;
  static_assert(Traits::n_arguments <= 1,
                "a target is an entry method of one argument, or of none");
  if constexpr (Traits::n_arguments == 1) {
    return std::type_identity<std::tuple_element_t<0, typename Traits::Arguments>>();
  } else {
    return std::type_identity<Without>();
  }
}

}  // namespace tess::detail
