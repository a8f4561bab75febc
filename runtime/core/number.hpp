// Numbers in a text of the user's: the whole of it, or what it begins with.
#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace tess {

/// Takes the number that a text begins with off it, as "2" of "2us" or "1e3" of "1e3,4". Nothing,
/// and the text as it was, for " 1", "+1" and what a T does not hold. A floating-point T takes
/// "inf" and "nan"; `base` is that of whole numbers.
template <class T>
[[nodiscard]] std::optional<T> take_number(std::string_view& text, int base = 10) {
  T number{};
  const char* const end = text.data() + text.size();
  std::from_chars_result read;
  if constexpr (std::integral<T>)
    read = std::from_chars(text.data(), end, number, base);
  else
    read = std::from_chars(text.data(), end, number);
  if (read.ec != std::errc()) return std::nullopt;
  text = {read.ptr, end};
  return number;
}

/// The number that the whole of a text is, or nothing.
template <class T>
[[nodiscard]] std::optional<T> parse_number(std::string_view text, int base = 10) {
  const std::optional<T> number = take_number<T>(text, base);
  return text.empty() ? number : std::nullopt;
}

}  // namespace tess
