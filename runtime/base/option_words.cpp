#include "runtime/base/option_words.hpp"

#include "runtime/base/words.hpp"
#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"

#include <cctype>

namespace tess::detail {
bool looks_like_option(std::string_view word) {
  return word.size() > 1 && word[0] == '-' && word[1] != '.' &&
         std::isdigit(static_cast<unsigned char>(word[1])) == 0;
}

std::string name_in(std::string_view word) {
  return std::string(word.substr(0, word.find('=')));
}

void refuse_unknown_option(const std::string& name, std::string_view help) {
  std::string names;
  while (!help.empty()) {
    std::string_view line = take_line(help);
    if (line.starts_with("  -")) names.append(take_word(line)) += ' ';
  }
  const std::string nearest = nearest_name(name, names);
  if (nearest.empty())
    fail(ErrorCode::bad_argument, "unknown option ", name, " (--help lists the options)");
  fail(ErrorCode::bad_argument, "unknown option ", name, " (did you mean ", nearest,
       "? --help lists the options)");
}

}  // namespace tess::detail
