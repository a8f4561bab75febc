// The words of a line of text.
#pragma once

#include <algorithm>
#include <string_view>

namespace tess::detail {

inline constexpr std::string_view blanks = " \t\r";

/// Removes the first word of a line, and returns it; empty if there is none.
[[nodiscard]] inline std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace tess::detail
