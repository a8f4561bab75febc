// A number in the text of a file, as other programs may have written it: with a plus sign, or
// beyond what floating point holds, which becomes zero or infinite.
#pragma once

#include <charconv>
#include <cstdlib>
#include <string>
#include <system_error>
#include <type_traits>

namespace tess::m2m {

/// Reads the number that [first, last) begins with, and returns its end, or `first` if there is
/// none.
template <class T>
const char* read_text_number(const char* first, const char* last, T& value) {
  const char* begin = first;
  if (last - first > 1 && *first == '+' && first[1] != '-') ++begin;
  const auto [end, error] = std::from_chars(begin, last, value);
  if (error == std::errc()) return end;
  if constexpr (std::is_floating_point_v<T>) {
    if (error == std::errc::result_out_of_range) {
      value = static_cast<T>(std::strtod(std::string(begin, end).c_str(), nullptr));
      return end;
    }
  }
  return first;
}

}  // namespace tess::m2m
