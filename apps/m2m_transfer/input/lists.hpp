// Lists on the command line.
#pragma once

#include <string>
#include <utility>
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
/// The same of an option that may be given several times.
[[nodiscard]] inline std::vector<std::string> split_names(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& list : lists)
    for (std::string& name : split_at_commas(list)) names.push_back(std::move(name));
  return names;
}

}  // namespace m2m_transfer
