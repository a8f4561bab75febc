#include "runtime/base/words.hpp"

#include "tests/support/catch.hpp"

#include <limits>
#include <string>
#include <vector>

namespace {

TEST_CASE("lines and words are taken from the front of a text", "[runtime][base]") {
  std::string_view text = "\t vertex  1\t2 \r\n\n \r\nend";
  std::vector<std::vector<std::string>> lines;
  while (!text.empty()) {
    std::string_view line = tess::detail::take_line(text);
    lines.emplace_back();
    for (auto word = tess::detail::take_word(line); !word.empty();
         word = tess::detail::take_word(line))
      lines.back().emplace_back(word);
    CHECK(line.empty());
  }
  CHECK(lines == std::vector<std::vector<std::string>>{{"vertex", "1", "2"}, {}, {}, {"end"}});
}

TEST_CASE("a word is a number from its first to its last character", "[runtime][base]") {
  struct Row {
    std::string_view word;
    double value;
  };
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const auto& [word, value] : {Row{"1.5", 1.5},
                                    {"+2e3", 2000},
                                    {"-.25", -.25},
                                    {"1e-400", 0},
                                    {"-1e400", -infinite},
                                    {"inf", infinite}}) {
    CAPTURE(word);
    double read = 7;
    CHECK(tess::detail::to_number(word, read));
    CHECK(read == value);
  }
  for (const std::string_view word : {"", "+", "+-1", "1.5x", "1,5", "0x10", "\v3", "one"}) {
    CAPTURE(word);
    double read = 7;
    CHECK_FALSE(tess::detail::to_number(word, read));
  }
}

}  // namespace
