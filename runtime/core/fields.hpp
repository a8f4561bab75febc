// The members of an aggregate: their number, and references to them, for serialisation and hashes.
//
//     struct Edge { int step; double at[3]; std::vector<double> values; };
//     fields_of(edge)      // std::tuple<int&, double (&)[3], std::vector<double>&>
//
// A member is counted by initialising it with {}, so one that is an array counts once. (Boost.PFR
// counts each element of it, and makes g++ 12 fail on members as std::vector<std::string> v{"a"}.)
// An aggregate with a base class, with more than 32 members, or with one that {} does not
// initialise does not compile here: it needs a serialize().
#pragma once

#include <boost/preprocessor/repetition/enum.hpp>
#include <boost/preprocessor/repetition/enum_params.hpp>
#include <boost/preprocessor/repetition/repeat_from_to.hpp>

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace tess::detail {

inline constexpr std::size_t most_fields = 32;

/// True if n times {} initialises a T: it has n members or more.
template <class T, std::size_t n>
consteval bool has_fields() {
#define TESS_BRACES(z, i, data) \
  {}
#define TESS_HAS_FIELDS(z, i, data) \
  if constexpr (n == (i)) return requires { T{BOOST_PP_ENUM_##z(i, TESS_BRACES, )}; };
  BOOST_PP_REPEAT_FROM_TO(1, 34, TESS_HAS_FIELDS, )
#undef TESS_HAS_FIELDS
#undef TESS_BRACES
}

/// The number of members, or most_fields + 1 if there are more.
template <class T, std::size_t n = 0>
consteval std::size_t n_fields() {
  if constexpr (n > most_fields || !has_fields<T, n + 1>()) {
    return n;
  } else {
    return n_fields<T, n + 1>();
  }
}

/// Becomes any base class of T.
template <class T>
struct AnyBase {
  template <class B>
    requires std::is_base_of_v<B, T>
  operator B() const;  // NOLINT(google-explicit-constructor)
};
struct Unrelated {};
/// A base class stands before the members, and takes what no member of a usual type takes.
template <class T>
inline constexpr bool has_base = requires { T{AnyBase<T>{}}; } && !requires { T{Unrelated{}}; };

/// References to the members, in order.
template <class T>
constexpr auto fields_of(T& value) {
  using Aggregate = std::remove_const_t<T>;
  constexpr std::size_t count = n_fields<Aggregate>();
  static_assert(
      !has_base<Aggregate>,
      "an aggregate with a base class needs `template <class Ar> void serialize(Ar& ar)`");
  static_assert(count > 0,
                "an aggregate whose members {} does not initialise needs `template <class Ar> void "
                "serialize(Ar& ar)`");
  static_assert(
      count <= most_fields,
      "an aggregate of more than 32 members needs `template <class Ar> void serialize(Ar& ar)`");
#define TESS_FIELDS_OF(z, i, data)                        \
  if constexpr (count == (i)) {                           \
    auto& [BOOST_PP_ENUM_PARAMS_Z(z, i, field)] = value;  \
    return std::tie(BOOST_PP_ENUM_PARAMS_Z(z, i, field)); \
  }
  BOOST_PP_REPEAT_FROM_TO(1, 33, TESS_FIELDS_OF, )
#undef TESS_FIELDS_OF
}

/// Calls a function with each member, in order.
template <class T, class Do>
constexpr void for_each_field(T& value, const Do& run) {
  std::apply([&run](auto&... field) { (run(field), ...); }, fields_of(value));
}

/// std::tuple of the types of the members.
template <class T>
using FieldTypes = decltype(fields_of(std::declval<T&>()));

}  // namespace tess::detail
