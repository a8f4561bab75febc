#include "apps/particles/scene/box_union.hpp"

#include "apps/particles/scene/scene.hpp"
#include "runtime/core/text.hpp"
#include "tests/support/catch.hpp"

#include <map>

using namespace particles;
using tess::dn::Bounds, tess::dn::Surface;

namespace {

double area_of(const Surface& surface) {
  double twice = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    twice += norm(cross(b - a, c - a));
  }
  return twice / 2;
}

double volume_of(const Surface& surface) {  // Gauss
  double six = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    six += dot(a, cross(b, c));
  }
  return six / 6;
}

/// As often along each edge one way as the other.
bool edges_cancel(const Surface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& t : surface.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      ++balance[{t[i], t[(i + 1) % 3]}];
      --balance[{t[(i + 1) % 3], t[i]}];
    }
  return std::all_of(balance.begin(), balance.end(),
                     [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

TEST_CASE("a union of boxes has its volume and its outer faces alone", "[particles][scene]") {
  struct Case {
    std::vector<Bounds> boxes;
    double volume, area;
  };
  const Bounds unit{{0, 0, 0}, {1, 1, 1}};
  const auto [boxes, volume, area] =
      GENERATE_COPY(Case{{unit}, 1, 6}, Case{{unit, unit}, 1, 6},
                    Case{{unit, {{1, 0, 0}, {2, 1, 1}}}, 2, 10},             // side by side
                    Case{{unit, {{3, 0, 0}, {4, 1, 1}}}, 2, 12},             // apart
                    Case{{unit, {{0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}}}, 1, 6},  // one within the other
                    Case{{{{0, 0, 0}, {2, 2, 1}}, {{1, 0.5, 0.5}, {3, 1.5, 2}}}, 6.5, 25});
  const Surface surface = union_of(boxes);
  CHECK(volume_of(surface) == Approx(volume).epsilon(1e-12));
  CHECK(area_of(surface) == Approx(area).epsilon(1e-12));
  CHECK(edges_cancel(surface));
}

TEST_CASE("boxes that cut one another into too many cells are refused", "[particles][scene]") {
  std::string boxes;
  for (int i = 0; i < 240; ++i)
    boxes += tess::text(i > 0 ? "," : "", R"({"low": [)", i, ",", i, ",", i, R"(], "high": [)",
                        i + 0.5, ",", i + 0.5, ",", i + 0.5, "]}");
  const std::string scene = R"({"dt": 1, "steps": 0, "objects": [{"shape": {"boxes": [)" + boxes +
                            R"(]}}], "emitters": [{"count": 1, "sphere": {"radius": 1}}]})";
  CHECK_THROWS_WITH(parse_scene(scene, "scene.json"),
                    Contains("cannot be joined: 240 boxes cut one another"));
}
