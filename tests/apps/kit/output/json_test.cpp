#include "apps/kit/output/json.hpp"

#include "tests/support/catch.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

using kit::Json;

namespace {

/// What nlohmann's library writes.
std::string expected(const nlohmann::ordered_json& json, int indent = 2) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

/// A value of either class, with all that programs write.
template <class AnyJson>
AnyJson report() {
  AnyJson out{{"machine", "threads: 2 PEs"},
              {"wall", {{"triangles", std::size_t{12}}, {"share", 0.25}, {"is_open", false}}},
              {"at", std::array{0.0, -0.5, 1e300}},
              {"cells", std::vector<std::int32_t>{2, -3}},
              {"inputs", std::vector<std::string>{"a.obj", "b \"c\".obj"}},
              {"none", std::vector<double>{}},
              {"order", nullptr}};
  out["rows"] = AnyJson::array();
  for (int step = 0; step < 3; ++step)
    out["rows"].push_back({{"step", step}, {"time", step * 0.1}, {"deep", {{"hash", "00"}}}});
  out["rows"].push_back(AnyJson{{"step", 3}});
  out["empty"] = AnyJson::array();
  out["new"]["member"] = true;
  out["list"].push_back("first");
  out["order"] = 2.0;
  out.update({{"machine", "another"}, {"last", AnyJson()}});
  AnyJson copy = out;
  out["itself"] = std::move(copy);
  return out;
}

}  // namespace

TEST_CASE("a report is written as nlohmann's library would write it", "[apps]") {
  for (const int indent : {-1, 0, 1, 2}) {
    const std::string text = kit::json_text(report<Json>(), indent);
    CHECK(text == expected(report<nlohmann::ordered_json>(), indent));
  }
  CHECK(kit::json_text(Json{{"a", 1}}) == "{\n  \"a\": 1\n}\n");
  CHECK(kit::json_text(Json()) == "null\n");
}

TEST_CASE("a number has the digits that nlohmann's library gives it", "[apps]") {
  using Real = std::numeric_limits<double>;
  for (const double value : {0.0,
                             -0.0,
                             1.0,
                             100.0,
                             0.1,
                             1e-4,
                             1e-5,
                             1e-9,
                             123456.789,
                             1e14,
                             1e15,
                             1e16,
                             1e17,
                             1e22,
                             1.5e300,
                             2.0 / 3,
                             0.39905357921110157,
                             Real::max(),
                             Real::min(),
                             Real::denorm_min(),
                             Real::infinity(),
                             -Real::infinity(),
                             Real::quiet_NaN()})
    CHECK(kit::json_text(value) == expected(value));
  CHECK(kit::json_text(std::numeric_limits<std::int64_t>::min()) == "-9223372036854775808\n");
  CHECK(kit::json_text(std::numeric_limits<std::uint64_t>::max()) == "18446744073709551615\n");
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (kit::json_text(value) != expected(value)) FAIL(expected(value));
  }
}

TEST_CASE("a string is escaped as by nlohmann's library, whatever its bytes", "[apps]") {
  std::string all;
  for (int c = 0; c < 128; ++c) all += static_cast<char>(c);
  CHECK(kit::json_text(all) == expected(all));
  CHECK(kit::json_text(Json{{all, "Größe → ∞ 𝛺"}}) == expected({{all, "Größe → ∞ 𝛺"}}));
  // All short texts of bytes at which the rules of UTF-8 change.
  const std::string bytes = "a\x7f\x80\x8f\x90\x9f\xa0\xbf\xc1\xc2\xdf\xe0\xe1\xed\xef\xf0\xf4\xf5";
  std::vector<std::string> texts{""};
  for (std::size_t i = 0; i < texts.size() && texts[i].size() < 4; ++i)
    for (const char c : bytes) texts.push_back(texts[i] + c);
  for (const std::string& text : texts)
    if (kit::json_text(text) != expected(text)) FAIL(expected(text));
}

TEST_CASE("a name that is no UTF-8 ends no program that writes it", "[apps]") {
  const Json named{{"mesh", "caf\xe9.vtu"}};
  CHECK(kit::json_text(named, -1) == "{\"mesh\":\"caf\xef\xbf\xbd.vtu\"}\n");
}

TEST_CASE("a table reads the numbers and names of a report", "[apps]") {
  const Json row{{"step", 3}, {"time", 0.5}, {"name", "a \"b\""}, {"none", nullptr}};
  CHECK(row.at("step").text() == "3");
  CHECK(row.at("time").kind() == Json::Kind::real);
  CHECK(row.at("time").real() == 0.5);
  CHECK(row.at("name").text() == "a \"b\"");
  CHECK(row.at("none").kind() == Json::Kind::null);
  CHECK(row.members().size() == 4);
  CHECK(row.members()[1].name == "time");
}
