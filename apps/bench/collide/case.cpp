#include "apps/bench/collide/case.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace bench {

using tess::collide::Point;
using tess::collide::Touching;

namespace {

std::array<float, 3> rounded(const Point& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}
Point widened(const std::array<float, 3>& p) {
  return {double{p[0]}, double{p[1]}, double{p[2]}};
}

}  // namespace

const std::vector<Case>& box_cases() {
  static const std::vector<Case> all{
      {"one_model", "wave:1048576", "a wavy plane; pairs of one model are not wanted",
       Pairing::across_models},
      {"wave_self", "wave:1048576", "a wavy plane with itself"},
      {"wave_open", "wave:1048576", "the same; boxes that only touch are no pairs", Pairing::all,
       Touching::does_not_count},
      {"planes", "planes:1048576", "two near-parallel wavy planes", Pairing::across_models},
      {"crossing", "crossing:1048576", "two wavy planes that cross", Pairing::across_models},
      {"boxes", "boxes:1000000", "random boxes of one scale"},
      {"disparity", "disparity:1000000", "random cubes, sizes over four decades"},
      {"disparity6", "disparity6:1000000", "random cubes, sizes over six decades"},
      {"dragon", "dragon:871414", "a closed knotted tube with itself"},
      {"crowd", "crowd:1048576", "8 192 bodies of uneven density", Pairing::across_models},
      {"triangles", "planes:65536", "exact pairs of triangles of two near-parallel wavy planes",
       Pairing::across_models, Touching::counts, true},
      {"short", "short_triangles:100000", "exact pairs of random triangles of one scale",
       Pairing::all, Touching::counts, true},
      {"needles", "needles:100000", "exact pairs of long thin triangles", Pairing::all,
       Touching::counts, true},
      {"long_needles", "long_needles:100000", "exact pairs of thin triangles twice as long",
       Pairing::all, Touching::counts, true},
      {"few", "boxes:4096", "random boxes, few enough for brute force"},
  };
  return all;
}

Case smaller(const Case& of, std::uint64_t divisor) {
  Case out = of;
  const std::size_t colon = of.scene.find(':');
  const std::uint64_t n = std::stoull(of.scene.substr(colon + 1));
  if (n <= 4096) return out;
  out.scene =
      fmt::format("{}:{}", of.scene.substr(0, colon), std::max<std::uint64_t>(1, n / divisor));
  return out;
}

std::size_t Problem::second_set() const {
  if (pairing == Pairing::all || models.empty() || models.front() != 0 || models.back() != 1)
    return 0;
  return static_cast<std::size_t>(std::find(models.begin(), models.end(), 1) - models.begin());
}

Problem make_problem(const Case& of, std::uint64_t seed) {
  const collide_scene::Scene scene = collide_scene::make_scene(of.scene, seed);
  Problem out{boxes_of(scene), {}, {}, {}, {}, of.pairing, of.touching};
  if (of.pairing == Pairing::across_models) out.models = scene.models;
  if (of.exact) out.triangles = scene.triangles;
  out.floats.reserve(out.boxes.size());
  for (const Aabb& box : out.boxes) out.floats.push_back({rounded(box.lo), rounded(box.hi)});
  for (const auto& [corners] : out.triangles)
    out.float_triangles.push_back(
        {{rounded(corners[0]), rounded(corners[1]), rounded(corners[2])}});
  return out;
}

Problem widened(const Problem& problem) {
  Problem out = problem;
  for (std::size_t i = 0; i < out.boxes.size(); ++i)
    out.boxes[i] = {widened(out.floats[i].lo), widened(out.floats[i].hi)};
  for (std::size_t i = 0; i < out.triangles.size(); ++i)
    out.triangles[i] = in_double(out.float_triangles[i]);
  return out;
}

}  // namespace bench
