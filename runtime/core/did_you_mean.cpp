#include "runtime/core/did_you_mean.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tess {
namespace {

/// How many letters to insert, remove, replace, or swap with their neighbour make b of a.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      d[i][j] = i + j;
      if (i == 0 || j == 0) continue;
      d[i][j] = std::min(
          {d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest_name(std::string_view word, std::string_view names) {
  constexpr std::string_view of_names =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  if (word.find(' ') != word.npos) return {};  // "block 4": not a part of a name
  std::string_view nearest;
  const std::size_t n_letters = word.starts_with('-') ? word.size() : word.size() + 2;
  std::size_t bound = std::min<std::size_t>(3, n_letters / 4 + 1);
  while (!names.empty()) {
    names.remove_prefix(std::min(names.find_first_of(of_names), names.size()));
    const std::string_view one = names.substr(0, names.find_first_not_of(of_names));
    names.remove_prefix(one.size());
    if (one.empty()) break;
    const std::size_t n = distance(word, one);
    if (n < bound) nearest = one;
    bound = std::min(bound, n);
  }
  return std::string(nearest);
}

std::string did_you_mean(std::string_view word, std::string_view names) {
  const std::string nearest = nearest_name(word, names);
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

}  // namespace tess
