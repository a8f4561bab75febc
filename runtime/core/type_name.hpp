// Names of types and functions, as the compiler spells them and in a readable form.
#pragma once

#include <string>
#include <string_view>
#include <typeinfo>

namespace tess {

namespace naming {
// g++ prints "… [with T = Block; std::string_view = …]", clang "… [T = Block]".
[[nodiscard]] constexpr std::string_view between(std::string_view name, std::string_view begin) {
  const auto from = name.find(begin) + begin.size();
  auto to = name.rfind("; std::string_view");
  if (to == std::string_view::npos) to = name.size() - 1;
  return name.substr(from, to - from);
}
template <class T>
[[nodiscard]] constexpr std::string_view type() {
  return between(__PRETTY_FUNCTION__, "T = ");
}
template <auto Value>
[[nodiscard]] constexpr std::string_view value() {
  return between(__PRETTY_FUNCTION__, "Value = ");
}

/// The name of a type or function for people, and a key that no other one in a program has: the
/// linker's name, since compilers print overloads alike, and clang instances of a template.
struct Name {
  std::string_view text;
  const std::type_info* tag;
  [[nodiscard]] std::string_view key() const { return tag->name(); }
};
template <class T>
struct TypeTag {};
template <auto Value>
struct ValueTag {};
template <class T>
[[nodiscard]] consteval Name name_of() {
  return {type<T>(), &typeid(TypeTag<T>)};
}
/// Returns the same for a class with virtual functions: it has a type_info already.
template <class T>
[[nodiscard]] consteval Name name_of_polymorphic() {
  return {type<T>(), &typeid(T)};
}
template <auto Value>
[[nodiscard]] consteval Name name_of() {
  return {value<Value>(), &typeid(ValueTag<Value>)};
}
}  // namespace naming

/// The name of a type as the compiler spells it: "Block".
template <class T>
inline constexpr std::string_view name_of_type = naming::type<T>();

/// True for what the user did not write: "tess::detail::call_arrives", but not
/// "tess::detail::Call<Block, &Block::step>" and not what a chare's construction is called.
[[nodiscard]] bool is_of_runtime(std::string_view compiler_name);

/// A function's or member function's name without the compiler's decoration: "Block::step".
[[nodiscard]] std::string plain_name(std::string_view compiler_name);

}  // namespace tess
