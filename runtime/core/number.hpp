// A text that is a number from its first to its last character.
#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace tess {

/// The number that the whole of a text is, or nothing: for "", " 1", "+1", "1x" and what a T does
/// not hold. A floating-point T takes "inf" and "nan"; `base` is that of whole numbers.
template <class T>
[[nodiscard]] std::optional<T> parse_number(std::string_view text, int base = 10) {
  T number{};
  const char* const end = text.data() + text.size();
  std::from_chars_result read;
  if constexpr (std::integral<T>)
    read = std::from_chars(text.data(), end, number, base);
  else
    read = std::from_chars(text.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return number;
}

}  // namespace tess
