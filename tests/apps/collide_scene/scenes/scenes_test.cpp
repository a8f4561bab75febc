// The scenes of collisions: what their comments promise, on small ones.
#include "apps/collide_scene/scenes/elementary.hpp"
#include "apps/collide_scene/scenes/scene.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/text.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <map>
#include <numbers>

using namespace collide_scene;
using tess::collide::Aabb, tess::collide::Point, tess::collide::Touching, tess::collide::Triangle;

namespace {

template <class Object>
std::uint64_t hash_of(const std::vector<Object>& objects) {
  return objects.empty() ? tess::hash_bytes("", 0)
                         : tess::hash_bytes(objects.data(), objects.size() * sizeof(Object));
}
std::uint64_t fingerprint(const Scene& scene) {
  return hash_of(boxes_of(scene)) ^ hash_of(scene.triangles);
}

/// Pairs of boxes that overlap, closed; within models, too, if `within`.
std::uint64_t n_pairs(const Scene& scene, bool within) {
  const auto boxes = boxes_of(scene);
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size(); ++j)
      if (overlap(boxes[i], boxes[j], Touching::counts) &&
          (within || scene.models[i] != scene.models[j]))
        ++n;
  return n;
}

/// Each directed edge of a closed surface stands once, and its reverse once.
bool is_closed(std::span<const Triangle> triangles) {
  std::map<std::pair<Point, Point>, int> edges;
  for (const auto& [corners] : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{corners[k], corners[(k + 1) % 3]}];
  for (const auto& [edge, n] : edges) {
    const auto reverse = edges.find({edge.second, edge.first});
    if (n != 1 || reverse == edges.end() || reverse->second != 1) return false;
  }
  return true;
}

double signed_volume(std::span<const Triangle> triangles) {
  double six = 0;
  for (const auto& [c] : triangles)
    six += c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1]) +
           c[0][1] * (c[1][2] * c[2][0] - c[1][0] * c[2][2]) +
           c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0]);
  return six / 6;
}

}  // namespace

TEST_CASE("sine, powers and roots agree with the C library", "[apps][collide_scene]") {
  for (int i = -4000; i <= 4000; ++i) {
    const double t = i / 1000.0;
    CHECK(std::abs(sine(t) - std::sin(2 * std::numbers::pi * t)) < 4e-15);
    CHECK(std::abs(cosine(t) - std::cos(2 * std::numbers::pi * t)) < 4e-15);
    CHECK(std::abs(power_of_two(5 * t) / std::exp2(5 * t) - 1) < 1e-15);
    CHECK(std::abs(cube_root(std::exp2(9 * t)) / std::cbrt(std::exp2(9 * t)) - 1) < 1e-15);
  }
  CHECK(sine(0.25) == 1);
  CHECK(cosine(0.5) == -1);
  CHECK(sine(3 / 32.0) == sine(13 / 32.0));
  CHECK(sine(3 / 32.0) == -sine(19 / 32.0));
  CHECK(cosine(1e6 + 0.25) == 0);
}

TEST_CASE("scenes have the same bits on every machine", "[apps][collide_scene]") {
  // Values of one machine. A change of a scene changes the meaning of kept results.
  const std::map<std::string, std::uint64_t> expected = {
      {"wave", 0x89b2921a503efbd9u},           {"planes", 0x931e9706d2d828a0u},
      {"crossing", 0x1190016f1f1698b5u},       {"dragon", 0xf9fdad07b899e4e7u},
      {"boxes", 0x6865daf30b037d5cu},          {"disparity", 0xaa3b50b7a631ad9cu},
      {"disparity6", 0xe7c0546df84aee8au},     {"lshapes", 0x9715e371e6f71458u},
      {"segments", 0x1200f380fe004e8bu},       {"crowd", 0x61a02e6944da4aecu},
      {"needles", 0x1619b60aad0506c0u},        {"long_needles", 0xf9232bfdd5d7681au},
      {"short_triangles", 0x77923acf27a3bffbu}};
  for (const SceneKind& kind : scene_kinds()) {
    const std::string text = std::string(kind.name) + ":1000";
    INFO(text);
    Scene scene = make_scene(text, 7);
    if (scene.move) scene.move(12.5, scene);
    REQUIRE(expected.contains(std::string(kind.name)));
    CHECK(fingerprint(scene) == expected.at(std::string(kind.name)));
  }
}

TEST_CASE("a scene has as many objects as it was asked for", "[apps][collide_scene]") {
  for (const char* name :
       {"wave", "planes", "crossing", "boxes", "disparity", "segments", "needles"})
    for (const int n : {1, 2, 3, 8, 1000, 4096, 5001}) {
      INFO(name << ':' << n);
      const Scene scene = make_scene(tess::text(name, ':', n));
      CHECK(scene.n_objects() == static_cast<std::size_t>(n));
      CHECK((scene.models.empty() || scene.models.size() == scene.n_objects()));
      for (const Aabb& box : boxes_of(scene)) REQUIRE(is_valid(box));
    }
  CHECK(make_scene("lshapes:5").n_objects() == 20);
  CHECK(make_scene("dragon:24").n_objects() == 24);
  CHECK(make_scene("dragon:100000").n_objects() > 99'000);
  CHECK(make_scene("crowd:1").n_objects() == 128);
}

TEST_CASE("the wave is the one of the specification", "[apps][collide_scene]") {
  const Scene scene = make_scene("wave:4096");  // 32 × 64 quads
  for (const auto& [corners] : scene.triangles)
    for (const Point& p : corners) {
      constexpr double turn = 2 * std::numbers::pi / 32;
      CHECK(std::abs(p[2] - 4 * std::sin(turn * p[0]) * std::cos(turn * p[1])) < 1e-13);
    }
  const Scene planes = make_scene("planes:8192");
  for (std::size_t t = 0; t < 4096; ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Point &p = planes.triangles[t].corners[c], &q = planes.triangles[t + 4096].corners[c];
      CHECK(q == Point{p[0] + 0.3, p[1] + 0.3, p[2] + 0.2});
    }
  CHECK(planes.models[4095] == 0);
  CHECK(planes.models[4096] == 1);
}

TEST_CASE("the dragon and the bodies of the crowd are closed", "[apps][collide_scene]") {
  const Scene knot = make_scene("dragon:5000");
  CHECK(is_closed(knot.triangles));
  CHECK(std::abs(signed_volume(knot.triangles)) > 5);
  Scene bodies = make_scene("crowd:640");
  for (const double step : {0.0, 1.0, 100.5}) {
    bodies.move(step, bodies);
    for (std::size_t b = 0; b < 5; ++b) {
      const auto body = std::span(bodies.triangles).subspan(128 * b, 128);
      CHECK(is_closed(body));
      CHECK(signed_volume(body) > 0.3);
    }
  }
}

TEST_CASE("random boxes have as many pairs per box whatever their number",
          "[apps][collide_scene]") {
  for (const int n : {2000, 6000}) {
    const auto per_box = [n](const char* name) {
      return static_cast<double>(n_pairs(make_scene(tess::text(name, ':', n)), true)) / n;
    };
    CHECK(per_box("boxes") == Approx(3.45).epsilon(0.25));
    // A box that is large beside the cube raises the density.
    CHECK(per_box("disparity") == Approx(10.5).epsilon(0.25));
    CHECK(per_box("disparity6") == Approx(10.5).epsilon(0.25));
  }
}

TEST_CASE("nested L shapes: all boxes overlap", "[apps][collide_scene]") {
  CHECK(n_pairs(make_scene("lshapes:100"), true) == 400 * 399 / 2);
  // Right angles at the corners, and parallel planes: no two shapes touch.
  const Scene scene = make_scene("lshapes:3");
  const auto& right = scene.triangles[2].corners;
  const auto& left = scene.triangles[0].corners;
  double product = 0;
  for (std::size_t k = 0; k < 3; ++k)
    product += (right[1][k] - right[0][k]) * (left[1][k] - left[0][k]);
  CHECK(std::abs(product) < 1e-15);
}

TEST_CASE("crossing segments have a quarter of n squared pairs", "[apps][collide_scene]") {
  CHECK(n_pairs(make_scene("segments:200"), false) == 10'000);
  CHECK(n_pairs(make_scene("segments:7"), false) == 12);
}

TEST_CASE("a text that is no scene is refused with the scenes there are", "[apps][collide_scene]") {
  CHECK(find_scene_kind("mesh.obj") == nullptr);
  CHECK(find_scene_kind("boxes:12") != nullptr);
  CHECK_THROWS_WITH(make_scene("cubes:3"), Contains("boxes"));
  for (const char* text : {"boxes:", "boxes:0", "boxes:-3", "boxes:1e6", "boxes:99999999999"})
    CHECK_THROWS_WITH(make_scene(text), Contains("no number from 1 to"));
}
