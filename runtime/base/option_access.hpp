// How an option of a command line reads and writes its variable, whose type is not known there.
#pragma once

#include "runtime/core/number.hpp"

#include <fmt/core.h>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace tess::detail {

using Texts = std::vector<std::string>;

/// What differs between the types of variables.
struct OptionAccess {
  const char* placeholder;
  const char* what;  ///< that one value has to be: "a number"
  bool is_whole, is_list;
  std::optional<long double> (*number)(const std::string& text);  ///< exact; null for text
  void (*assign)(void* variable, const Texts& values);
  std::string (*text)(const void* variable);
};

/// How a variable of this type is assigned, and its text; One is the type of one value.
template <class T>
struct OptionVariable {
  using One = T;
  static void assign(T& to, const Texts& values) { to = parse_number<T>(values.front()).value(); }
  static std::string text(const T& value) { return fmt::format("{}", value); }
};
template <>
struct OptionVariable<std::string> {
  using One = std::string;
  static void assign(One& to, const Texts& values) { to = values.empty() ? One() : values.front(); }
  static std::string text(const One& value) { return value; }
};
template <>
struct OptionVariable<bool> {
  using One = std::string;
  static void assign(bool& to, const Texts& /*none*/) { to = true; }
  static std::string text(bool value) { return value ? "yes" : "no"; }
};
template <class T>
struct OptionVariable<std::optional<T>> : OptionVariable<T> {
  static void assign(auto& to, const Texts& values) {
    OptionVariable<T>::assign(to.emplace(), values);
  }
  static std::string text(const auto& value) {
    return value ? OptionVariable<T>::text(*value) : "";
  }
};
template <class T>
struct OptionVariable<std::vector<T>> : OptionVariable<T> {
  static void assign(std::vector<T>& to, const Texts& values) {
    to.resize(values.size());
    for (std::size_t i = 0; i < to.size(); ++i) OptionVariable<T>::assign(to[i], {values[i]});
  }
  static std::string text(const std::vector<T>& value) {
    std::string out;
    for (const T& one : value) (out += OptionVariable<T>::text(one)) += ',';
    if (!out.empty()) out.pop_back();
    return out;
  }
};

template <class T>
constexpr OptionAccess access_to() {
  using One = typename OptionVariable<T>::One;
  OptionAccess access{
      "TEXT",  "",     std::is_integral_v<One>, std::is_same_v<T, std::vector<One>>, nullptr,
      nullptr, nullptr};
  if constexpr (!std::is_same_v<One, std::string>) {
    access.placeholder = access.is_whole ? "N" : "X";
    access.what = !access.is_whole   ? "a number"
                  : sizeof(One) == 4 ? "a whole number from -2147483648 to 2147483647"
                                     : "a whole number from 0 to 18446744073709551615";
    access.number = [](const std::string& text) -> std::optional<long double> {
      return parse_number<One>(text);
    };
  }
  access.assign = [](void* to, const Texts& values) {
    OptionVariable<T>::assign(*static_cast<T*>(to), values);
  };
  access.text = [](const void* of) { return OptionVariable<T>::text(*static_cast<const T*>(of)); };
  return access;
}

}  // namespace tess::detail
