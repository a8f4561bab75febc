#include "runtime/base/option_words.hpp"

#include "runtime/base/words.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <vector>

namespace tess::detail {
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

bool looks_like_option(std::string_view word) {
  return word.size() > 1 && word[0] == '-' && word[1] != '.' &&
         std::isdigit(static_cast<unsigned char>(word[1])) == 0;
}

std::string name_in(std::string_view word) {
  return std::string(word.substr(0, word.find('=')));
}

void refuse_unknown_option(const std::string& name, std::string_view help) {
  std::string_view nearest;
  std::size_t bound = std::min<std::size_t>(3, name.size() / 4 + 1);
  while (!help.empty()) {
    std::string_view line = take_line(help);
    if (!line.starts_with("  -")) continue;
    for (std::string_view names = take_word(line); !names.empty();) {  // "-h,--help"
      const std::string_view one = names.substr(0, names.find(','));
      names.remove_prefix(std::min(one.size() + 1, names.size()));
      const std::size_t n = distance(name, one);
      if (n < bound) nearest = one;
      bound = std::min(bound, n);
    }
  }
  if (nearest.empty())
    fail(ErrorCode::bad_argument, "unknown option ", name, " (--help lists the options)");
  fail(ErrorCode::bad_argument, "unknown option ", name, " (did you mean ", nearest,
       "? --help lists the options)");
}

}  // namespace tess::detail
