// The lines of a text, the words of a line, and numbers among them. Every reader of text begins with
// without_byte_order_mark().
#pragma once

#include <algorithm>
#include <string_view>

namespace tess::detail {

[[nodiscard]] constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// The text behind the mark of UTF-8 that some editors and programs put in front of it.
[[nodiscard]] constexpr std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

/// Removes the first word of a line, and returns it; empty if there is none.
[[nodiscard]] inline std::string_view take_word(std::string_view& line) {
  const auto begin = std::find_if_not(line.begin(), line.end(), is_blank);
  const auto end = std::find_if(begin, line.end(), is_blank);
  line = {end, line.end()};
  return {begin, end};
}

/// Removes the first line of a text and its end, and returns it.
[[nodiscard]] inline std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

/// Reads a word that is a number from its first to its last character; false if it is none. A
/// number that is too small for a double is 0, and one that is too large infinite.
[[nodiscard]] bool to_number(std::string_view word, double& to);

}  // namespace tess::detail
