// The properties of an entry method: its class, its arguments as values, and whether it is a
// coroutine. Also the messages that the compiler prints if a member function cannot be one.
#pragma once

#include <tuple>
#include <type_traits>

namespace tess {
class Task;
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

/// Checks that F is an entry method of C that can be called with these arguments.
template <class C, auto F, class... Args>
consteval bool check_entry() {
  using Traits = EntryTraits<F>;
  static_assert(Traits::is_member,
                "an entry method is a member function: send<&Class::function>(…)");
  if constexpr (Traits::is_member) {
    static_assert(
        std::is_base_of_v<typename Traits::Class, C>,
        "this entry method belongs to another class than the elements of this collection");
    static_assert(
        std::is_void_v<typename Traits::Result> || std::is_same_v<typename Traits::Result, Task>,
        "an entry method returns void or tess::Task");
    static_assert(Traits::n_arguments <= 2,
                  "an entry method takes at most two arguments: put more into one aggregate");
    static_assert(Traits::by_value_or_const,
                  "an entry method takes its arguments by value or const reference");
    static_assert(std::is_void_v<typename Traits::Result> || Traits::by_value,
                  "a coroutine takes its arguments by value: the message is gone once it waits");
    static_assert(std::is_constructible_v<typename Traits::Arguments, Args...> &&
                      sizeof...(Args) == Traits::n_arguments,
                  "these arguments are not what the entry method takes");
  }
  return true;
}

}  // namespace tess::detail
