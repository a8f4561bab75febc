#include "runtime/base/words.hpp"

#include "tests/support/catch.hpp"

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

}  // namespace
