#include "apps/plot/json_text.hpp"

#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>

TEST_CASE("a name that is no UTF-8 ends no program that writes it", "[apps]") {
  const nlohmann::ordered_json named{{"mesh", "caf\xe9.vtu"}};
  CHECK(plot::json_text(named, -1) == "{\"mesh\":\"caf\xef\xbf\xbd.vtu\"}\n");
  CHECK(plot::json_text(nlohmann::json{{"a", 1}}) == "{\n  \"a\": 1\n}\n");
}
