// Lists on the command line.
#pragma once

#include <string>
#include <vector>

namespace m2m_transfer {

/// "a,b" has two entries; commas within parentheses separate none: "max(x,y),z" has two.
[[nodiscard]] inline std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace m2m_transfer
