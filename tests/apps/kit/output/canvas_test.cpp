#include "apps/kit/output/canvas.hpp"

#include "tests/apps/xml.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

namespace {

constexpr std::array<kit::Rgb, 3> stops{{{0, 0, 0}, {100, 200, 50}, {255, 255, 255}}};

}  // namespace

TEST_CASE("a ramp of colours passes through its stops, and ends at them", "[kit]") {
  CHECK(kit::hex_colour(kit::colour_between(stops, 0)) == "#000000");
  CHECK(kit::hex_colour(kit::colour_between(stops, 0.5)) == "#64c832");
  CHECK(kit::hex_colour(kit::colour_between(stops, 1)) == "#ffffff");
  CHECK(kit::colour_between(stops, 7) == stops[2]);
  CHECK(kit::colour_between(stops, 0.25) == kit::Rgb{50, 100, 25});
  CHECK(kit::hex_colour(stops[1], 0.5) == "#326419");
}

TEST_CASE("a canvas holds what was drawn, in order, with any text", "[kit]") {
  kit::Canvas canvas({.width = 100, .height = 50, .margin = 10});
  canvas.clip("inside", {1, 2}, 30, 40);
  canvas.begin({5, 0}, {.opacity = 0.5});
  canvas.text({1.25, 2}, "a < b & \"c\"", kit::Anchor::end, 9);
  canvas.end();
  canvas.path(kit::Path().move({0, 0}).line({1.04, 2}).close().right(0),
              {.fill = "none", .stroke = "#bbb", .width = 0.8, .round = true, .clip = "inside"});
  canvas.path(kit::Path(), {.fill = "red"});
  canvas.circle({1, 2}, 3, {.fill = "blue"});
  canvas.ramp({0, 0}, 10, 5, 4, stops);

  const std::string svg = canvas.svg();
  CHECK_THAT(svg, Contains("viewBox=\"-10 -10 120 70\""));
  CHECK_THAT(svg, Contains("a &lt; b &amp; "));
  CHECK_THAT(svg, Contains("clip-path=\"url(#inside)\" d=\"M0.0 0.0L1.0 2.0Zh0\""));
  const auto elements = tess::test::read_xml(svg);
  const auto n = [&](const char* name) {
    return std::ranges::count(elements, name, &tess::test::XmlElement::name);
  };
  CHECK(n("path") == 1);  // an empty one is left out
  CHECK(n("rect") == 6);  // the page, the region and the ramp
  CHECK(n("text") == 1);
  CHECK(n("g") == 1);
}
