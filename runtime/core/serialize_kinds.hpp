// What kinds of values serialize.hpp knows, and which of them are copied as bytes.
#pragma once

#include "runtime/core/buffer.hpp"
#include "runtime/core/fields.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <memory>
#include <optional>
#include <tuple>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

namespace tess {

class Writer;

namespace serialization {

template <class T>
concept HasSerialize = requires(T& value, Writer& ar) { value.serialize(ar); };
/// A function beside the type, or in namespace tess for types of other libraries.
template <class T>
concept HasFreeSerialize =
    !HasSerialize<T> && requires(T& value, Writer& ar) { serialize(ar, value); };

/// The class that a member function is declared in.
template <class Member>
struct ClassOf;
template <class F, class C>
struct ClassOf<F C::*> : std::type_identity<C> {};
/// True if T is A, or adds no members to its base class A.
template <class A, class T>
consteval bool holds_all_of() {
  if constexpr (std::is_base_of_v<A, T>) {
    return sizeof(A) == sizeof(T);
  } else {
    return false;
  }
}
/// True for a template with such a class among its parameters: as a base class it may know all
/// members of T.
template <class By, class T>
inline constexpr bool knows = false;
template <template <class...> class B, class... A, class T>
inline constexpr bool knows<B<A...>, T> = (holds_all_of<A, T>() || ...);
/// True if T declares serialize() itself, or adds no members to the base class that does, or if that
/// class knows T. `Beside` is a base class of T that is serialised elsewhere. A member in the padding
/// of a base class is not noticed.
template <class T, class Beside = void>
consteval bool serialises_all() {
  if constexpr (requires { &T::template serialize<Writer>; }) {
    using By = typename ClassOf<decltype(&T::template serialize<Writer>)>::type;
    if constexpr (std::is_void_v<Beside> || std::is_base_of_v<Beside, By>) {
      return sizeof(T) == sizeof(By) || knows<By, T>;
    } else {
      struct Both : Beside, By {};
      return sizeof(T) <= sizeof(Both) || knows<By, T>;
    }
  } else {
    return true;
  }
}
template <class T>
concept Duration = requires { typename T::period; } && std::is_arithmetic_v<typename T::rep>;
/// std::complex, without its header.
template <class T>
concept Complex = requires(const T& z) {
  requires std::is_arithmetic_v<typename T::value_type>;
  requires std::is_trivially_copyable_v<T> && sizeof(T) == 2 * sizeof(typename T::value_type);
  { z.real() } -> std::convertible_to<typename T::value_type>;
  { z.imag() } -> std::convertible_to<typename T::value_type>;
};
template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T> || Duration<T> || Complex<T>;
/// std::shared_ptr and its like.
template <class T>
concept SharedPointer = requires(const T& pointer) {
  *pointer;
  pointer.use_count();
};
template <class T>
concept TupleLike = requires { std::tuple_size<T>::value; } && !std::is_aggregate_v<T>;
template <class T>
concept Resizable = requires(T& c, std::size_t n) {
  c.resize(n);
  c.data();
  c.size();
  typename T::value_type;
};
/// True for an aggregate with members beside the container that it is.
template <class T>
consteval bool holds_more() {
  if constexpr (std::is_aggregate_v<T>) {
    return detail::n_fields<T>() > 1;
  } else {
    return false;
  }
}
template <class T>
concept Growable = requires(T& c, typename T::value_type v) {
  c.clear();
  c.insert(c.end(), std::move(v));
  c.size();
};

template <class T>
struct IsArray : std::false_type {};
template <class T, std::size_t N>
struct IsArray<std::array<T, N>> : std::true_type {};
template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::bool_constant<!std::is_same_v<T, bool>> {};
/// Its memory stays when it moves, so it can be attached; a string may hold its bytes inside
/// itself.
template <class T>
concept StaysInPlace = IsVector<T>::value || std::is_same_v<T, detail::Buffer>;
/// The type passes only its own members to an archive, never a temporary: they may be attached.
template <class T>
concept GivesMembers = requires { typename T::GivesMembers; };
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};
template <class T>
struct IsVariant : std::false_type {};
/// std::variant and Boost's, without their headers: most programs have none.
template <template <class...> class V, class... T>
  requires requires(const V<T...>& value) {
    value.valueless_by_exception();
    value.index();
  }
struct IsVariant<V<T...>> : std::true_type {
  static constexpr std::size_t n_alternatives = sizeof...(T);
};
template <class T>
struct IsUnique : std::false_type {};
template <class T>
struct IsUnique<std::unique_ptr<T>> : std::true_type {};
template <class T>
consteval bool is_bitwise();

template <class T, class... Fields>
consteval bool fields_are_bitwise(std::type_identity<std::tuple<Fields&...>> /*fields*/) {
  return (is_bitwise<Fields>() && ...) && (sizeof(Fields) + ... + 0) == sizeof(T);
}

/// True if the value can be copied as bytes and has no padding.
template <class T>
consteval bool is_bitwise() {
  if constexpr (HasFreeSerialize<T>) {
    return false;
  } else if constexpr (Number<T>) {
    return true;
  } else if constexpr (IsArray<T>::value) {
    return is_bitwise<typename T::value_type>();
  } else if constexpr (std::is_array_v<T>) {
    return is_bitwise<std::remove_extent_t<T>>();
  } else if constexpr (std::is_aggregate_v<T> && std::is_trivially_copyable_v<T> &&
                       !HasSerialize<T> && !std::is_union_v<T>) {
    if constexpr (std::is_empty_v<T>) {
      return false;
    } else {
      return fields_are_bitwise<T>(std::type_identity<detail::FieldTypes<T>>());
    }
  } else {
    return false;
  }
}

/// True if a value takes a byte or more, whatever it holds; false if only its serialize() knows.
template <class T>
consteval bool always_takes_bytes() {
  if constexpr (is_bitwise<T>()) {
    return true;
  } else if constexpr (HasSerialize<T> || HasFreeSerialize<T> || std::is_empty_v<T>) {
    return false;
  } else if constexpr (std::is_aggregate_v<T> && !IsArray<T>::value && !Resizable<T> &&
                       !Growable<T>) {
    return []<class... Fields>(std::type_identity<std::tuple<Fields&...>>) {
      return (always_takes_bytes<Fields>() || ...);
    }(std::type_identity<detail::FieldTypes<T>>());
  } else {
    return Resizable<T> || Growable<T> || IsOptional<T>::value || IsVariant<T>::value ||
           IsUnique<T>::value;
  }
}

/// Ends the job if an object is written as one of its base class: what derives would be lost.
void check_whole(const std::type_info& object, const std::type_info& written_as);

}  // namespace serialization

/// A value that can be copied as bytes.
template <class T>
concept Bitwise = serialization::is_bitwise<std::remove_cv_t<T>>();

}  // namespace tess
