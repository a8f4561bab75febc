#include "runtime/base/json_string.hpp"

#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>
#include <string>

TEST_CASE("a JSON library reads every character of a JSON string back", "[runtime]") {
  std::string all;
  for (int c = 0; c < 128; ++c) all += static_cast<char>(c);
  all += "Größe → ∞";
  for (const std::string& text : {all, std::string(), std::string("Cell<\"a\\b\">\n")})
    CHECK(nlohmann::json::parse(tess::detail::json_string(text)) == text);
}
