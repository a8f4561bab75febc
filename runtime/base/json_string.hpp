// A text as a JSON string, for what is written without a JSON library: the trace and the live view.
#pragma once

#include <fmt/format.h>
#include <string>
#include <string_view>

namespace tess::detail {

/// With its quotation marks.
[[nodiscard]] inline std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

}  // namespace tess::detail
