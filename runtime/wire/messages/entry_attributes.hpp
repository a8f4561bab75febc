// Priorities, and the attributes of entry methods. A chare lists them in its class, behind the
// entry methods that it names:
//
//     class Cell : public tess::Chare<Cell, tess::Index2> {
//      public:
//       void halo(Edge edge);
//       void refine(int level);
//       using EntryAttributes =
//           tess::Attributes<tess::EntryMethod<&Cell::halo, tess::inline_when_local>,
//                            tess::EntryMethod<&Cell::refine, tess::Priority{5}, tess::create_home>>;
//     };
//
// EntryAttributes is public. Attributes hold for every message to the entry method, a priority also
// for its broadcasts, and inline_when_local for send() only.
#pragma once

#include "runtime/wire/messages/class_options.hpp"
#include "runtime/wire/messages/entry_traits.hpp"

#include <cstdint>
#include <limits>

namespace tess {

namespace detail {
/// What a message requests if its element does not exist.
enum class Demand : std::uint8_t {
  none,              ///< wait at home until the element is created
  here,              ///< create it by its default constructor on the sending PE
  home,              ///< create it by its default constructor on the home PE of the index
  insert,            ///< the message is a constructor call; misuse if the element exists
  insert_if_absent,  ///< the message is a constructor call; no effect if the element exists
  member,  ///< as none, but once an element was destroyed it is dropped, whatever the array
};
}  // namespace detail

/// Of the messages that are ready on a PE the one with the smallest number runs first; equal ones
/// run in the order in which they reached the queue. A message without a priority has 0.
struct Priority {
  std::int64_t value = 0;
  friend constexpr bool operator==(const Priority&, const Priority&) = default;
};
/// The priority before all others.
inline constexpr Priority expedited{std::numeric_limits<std::int64_t>::min()};

struct InlineWhenLocal {};
struct CreateHere {
  static constexpr auto demand = detail::Demand::here;
};
struct CreateHome {
  static constexpr auto demand = detail::Demand::home;
};
/// A message to an element of this PE runs inside send(), if an entry method sends it and no code
/// of the element runs or waits. Otherwise, and in a deep chain of such calls, it is queued as
/// usual. An element that ends or moves by it does so once the sender's message is done.
inline constexpr InlineWhenLocal inline_when_local{};
/// send() acts as send_or_create_here(), and ask() creates the element likewise.
inline constexpr CreateHere create_here{};
/// send() acts as send_or_create_home(), and ask() creates the element likewise.
inline constexpr CreateHome create_home{};

/// The attributes of entry method F.
template <auto F, auto... Of>
struct EntryMethod {};
/// What a chare says about its entry methods, as its member type EntryAttributes.
template <class... Entries>
struct Attributes {};

}  // namespace tess

namespace tess::detail {

/// Where a message creates its element.
template <class T>
concept CreatesWhere = std::is_same_v<T, CreateHere> || std::is_same_v<T, CreateHome>;

/// What a class says about one entry method.
struct EntryRule {
  std::int64_t priority = 0;
  bool inlined = false;
  Demand demand = Demand::none;
};

constexpr void apply(EntryRule& rule, Priority priority) {
  rule.priority = priority.value;
}
constexpr void apply(EntryRule& rule, InlineWhenLocal /*of*/) {
  rule.inlined = true;
}
constexpr void apply(EntryRule& rule, CreatesWhere auto where) {
  rule.demand = where.demand;
}

template <class T, class... Others>
inline constexpr bool is_one_of = (std::is_same_v<T, Others> || ...);

template <auto F, class One>
struct RuleOf {
  static constexpr bool names = false;
};
template <auto F, auto... Of>
struct RuleOf<F, EntryMethod<F, Of...>> {
  static constexpr bool names = true;
  static constexpr EntryRule rule = [] {
    constexpr bool known = (is_one_of<std::remove_cv_t<decltype(Of)>, Priority, InlineWhenLocal,
                                      CreateHere, CreateHome> &&
                            ...);
    static_assert(known,
                  "an attribute of an entry method is tess::inline_when_local, tess::create_here, "
                  "tess::create_home or a tess::Priority");
    static_assert((0 + ... + int{std::is_same_v<std::remove_cv_t<decltype(Of)>, Priority>}) <= 1,
                  "an entry method has one priority");
    static_assert((0 + ... + int{CreatesWhere<std::remove_cv_t<decltype(Of)>>}) <= 1,
                  "an entry method creates its element in one place: create_here or create_home");
    EntryRule made;
    if constexpr (known) (apply(made, Of), ...);
    return made;
  }();
};

template <class C, class One>
struct EntryOf {
  static constexpr bool is_entry = false, is_of_class = true;
};
template <class C, auto F, auto... Of>
struct EntryOf<C, EntryMethod<F, Of...>> {
  static constexpr bool is_entry = true;
  static constexpr bool is_of_class = [] {
    if constexpr (MemberTraits<decltype(F)>::is_member) {
      return std::is_base_of_v<typename MemberTraits<decltype(F)>::Class, C>;
    } else {
      return false;
    }
  }();
};

template <class C, auto F, class... Entries>
consteval EntryRule rule_among(Attributes<Entries...>* /*of*/) {
  static_assert((EntryOf<C, Entries>::is_entry && ...),
                "EntryAttributes holds tess::EntryMethod<&Class::function, attributes…>");
  static_assert((EntryOf<C, Entries>::is_of_class && ...),
                "EntryAttributes names a function that is no member of its class");
  static_assert((0 + ... + int{RuleOf<F, Entries>::names}) <= 1,
                "EntryAttributes names an entry method twice");
  EntryRule rule;
  [[maybe_unused]] const auto take = [&rule]<class One>(std::type_identity<One>) {
    if constexpr (RuleOf<F, One>::names) rule = RuleOf<F, One>::rule;
  };
  (take(std::type_identity<Entries>()), ...);
  return rule;
}
template <class C, auto F, class Other>
consteval EntryRule rule_among(Other* /*of*/) {
  static_assert(sizeof(Other*) == 0, "the EntryAttributes of a chare are tess::Attributes<…>");
  return {};
}

template <class C, auto F>
consteval EntryRule find_rule() {
  if constexpr (requires { typename C::EntryAttributes; }) {
    return rule_among<C, F>(static_cast<typename C::EntryAttributes*>(nullptr));
  } else {
    static_assert(!NamesEntryAttributes<C>,
                  "EntryAttributes is a public type of its class: move it behind `public:` (or, if "
                  "several base classes have one, name one in the class)");
    return {};
  }
}
/// What class C says about its entry method F.
template <class C, auto F>
inline constexpr EntryRule entry_rule = find_rule<C, F>();

}  // namespace tess::detail
