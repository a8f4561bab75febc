#include "apps/collide_scaling/pieces.hpp"

#include "apps/collide_scene/scenes/crowd.hpp"
#include "apps/collide_scene/scenes/elementary.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

namespace collide_scaling {
namespace {

using namespace tess::collide;
using collide_scene::Crowd;

/// The PEs stand in a rectangle of `wide` columns, as square as it can be.
std::int32_t columns_of(std::int32_t n_pes) {
  auto wide = static_cast<std::int32_t>(std::sqrt(n_pes));
  while (n_pes % wide != 0) --wide;
  return wide;
}

/// The bodies of a crowd, neighbours next to each other.
struct Sorted {
  std::uint64_t n_triangles = 0;
  std::unique_ptr<Crowd> crowd;
  std::vector<std::uint64_t> order;
};

const Sorted& sorted_crowd(std::uint64_t n_triangles) {
  static Sorted kept;
  if (kept.n_triangles == n_triangles) return kept;
  kept.n_triangles = n_triangles;
  kept.crowd = std::make_unique<Crowd>(n_triangles / Crowd::triangles_per_body, 1);
  const std::uint64_t n = kept.crowd->n_bodies();
  std::vector<Point> places(n);
  std::vector<Triangle> triangles(Crowd::triangles_per_body);
  for (std::uint64_t b = 0; b < n; ++b) {
    kept.crowd->triangles(b, 0, triangles);
    places[b] = triangles[0].corners[0];
  }
  kept.order.resize(n);
  std::iota(kept.order.begin(), kept.order.end(), 0);
  // Halves along the longest axis, again and again.
  const auto halve = [&](const auto& self, std::uint64_t begin, std::uint64_t end) -> void {
    if (end - begin < 2) return;
    Aabb all = no_box<double, 3>();
    for (std::uint64_t i = begin; i < end; ++i) all = merged(all, box_of(places[kept.order[i]]));
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (all.hi[k] - all.lo[k] > all.hi[axis] - all.lo[axis]) axis = k;
    const std::uint64_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::uint64_t i) {
      return kept.order.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint64_t a, std::uint64_t b) {
      return places[a][axis] < places[b][axis];
    });
    self(self, begin, middle);
    self(self, middle, end);
  };
  halve(halve, 0, n);
  return kept;
}

}  // namespace

std::vector<Body> tile_of(const Case& given, std::int32_t pe) {
  const std::int32_t wide = columns_of(given.n_pes);
  const auto side = static_cast<std::int32_t>(
      std::sqrt(static_cast<double>(given.n_triangles) / (4 * given.thinned)));
  std::vector<Body> out;
  for (const std::uint32_t plane : {0U, 1U}) {
    const double shift = plane == 0 ? 0 : 0.3, lift = plane == 0 ? 0 : given.gap;
    const auto corner = [&](std::int32_t i, std::int32_t j) {
      return Point{i + shift, j + shift,
                   4 * collide_scene::sine(i / 32.0) * collide_scene::cosine(j / 32.0) + lift};
    };
    std::vector<Aabb> boxes;
    boxes.reserve(static_cast<std::size_t>(2 * side * side));
    for (std::int32_t j = pe / wide * side; j < (pe / wide + 1) * side; ++j)
      for (std::int32_t i = pe % wide * side; i < (pe % wide + 1) * side; ++i) {
        const Point b = corner(i + 1, j), d = corner(i, j + 1);
        boxes.push_back(box_of(Triangle{{corner(i, j), b, d}}));
        boxes.push_back(box_of(Triangle{{b, corner(i + 1, j + 1), d}}));
      }
    out.push_back({ModelId{plane}, std::move(boxes)});
  }
  return out;
}

std::vector<Body> bodies_of(const Case& given, std::int32_t pe, std::int32_t step) {
  const Sorted& sorted = sorted_crowd(given.n_triangles);
  const std::uint64_t n = sorted.order.size();
  const auto first = [&](std::int32_t of) {
    return n * static_cast<std::uint64_t>(of) / static_cast<std::uint64_t>(given.n_pes);
  };
  std::vector<Body> out;
  std::vector<Triangle> triangles(Crowd::triangles_per_body);
  for (std::uint64_t i = first(pe); i < first(pe + 1); ++i) {
    const std::uint64_t body = sorted.order[i];
    sorted.crowd->triangles(body, step, triangles);
    std::vector<Aabb> boxes;
    for (const Triangle& triangle : triangles) boxes.push_back(box_of(triangle));
    out.push_back({ModelId{static_cast<std::uint32_t>(body)}, std::move(boxes)});
  }
  return out;
}

}  // namespace collide_scaling
