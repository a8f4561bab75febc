// Levels of pictures and heat maps as browsers receive them.
#pragma once

#include <string>

namespace tess::detail {

/// Adds a level from 0 to 255 to a text, as two hexadecimal digits.
inline void add_level(std::string& out, long level) {
  constexpr const char* digits = "0123456789abcdef";
  out += digits[static_cast<unsigned long>(level) >> 4U & 15U];
  out += digits[static_cast<unsigned long>(level) & 15U];
}

}  // namespace tess::detail
