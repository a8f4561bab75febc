#include "collide/dn_field/build/sign.hpp"

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>

namespace tess::dn {
namespace {
constexpr int tile_edge = 16, least_edge = 2;
constexpr double accuracies[] = {2, 4, 12, HUGE_VAL};

/// Triangles that close `surface`; their apexes are appended to its vertices. An apex is a little
/// off the middle of its rim, so that caps do not lie in planes of voxels.
std::vector<std::array<std::uint32_t, 3>> close(Surface& surface,
                                                const std::vector<RimEdge>& edges) {
  boost::disjoint_sets_with_storage<> pieces(surface.vertices.size());
  for (const RimEdge& e : edges) pieces.union_set(e.from, e.to);
  struct Middle {
    Vec3 sum;
    double count = 0;
    Bounds box;
    std::uint32_t apex = 0;
  };
  std::vector<Middle> middle(surface.vertices.size());
  for (const RimEdge& e : edges) {
    Middle& m = middle[pieces.find_set(e.from)];
    for (const std::uint32_t v : {e.from, e.to}) {
      m.sum += surface.vertices[v];
      m.box.extend(surface.vertices[v]);
      m.count += 1;
    }
  }
  for (Middle& m : middle) {
    if (m.count == 0) continue;
    m.apex = static_cast<std::uint32_t>(surface.vertices.size());
    const Vec3 aside{0.0061803398875, 0.0041421356237, 0.0073205080757};
    surface.vertices.push_back((1 / m.count) * m.sum + norm(m.box.size()) * aside);
  }
  std::vector<std::array<std::uint32_t, 3>> caps;
  for (const RimEdge& e : edges)
    for (int i = 0; i < e.surplus; ++i)
      caps.push_back({e.to, e.from, middle[pieces.find_set(e.from)].apex});
  return caps;
}

/// Relative cost of a sum over the triangles of `surface`: their number times their area.
double cost(const Surface& surface) {
  double area = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    area += norm(cross(b - a, c - a));
  }
  return area * static_cast<double>(surface.triangles.size());
}

/// Distance to the nearest integer.
double off_integer(double x) {
  return std::abs(x - std::round(x));
}

}  // namespace

Inside::Inside(const OutwardSurface& surface, const Bvh& tree, const Grid& grid)
    : tree_(tree), grid_(grid) {
  Surface whole = surface.surface();
  if (!surface.is_closed()) {
    const auto edges = rim(whole);
    Surface caps;
    caps.triangles = close(whole, edges);
    caps.vertices = whole.vertices;
    if (cost(caps) > cost(whole)) return;
    caps_.emplace(caps);
    whole.triangles.insert(whole.triangles.end(), caps.triangles.begin(), caps.triangles.end());
  }
  lines_.emplace(std::move(whole), grid);
}

WindingEstimate Inside::excess(Vec3 p, double radius, double accuracy) const {
  if (caps_) return caps_->winding_estimate(p, radius, accuracy);
  const WindingEstimate all = tree_.winding_estimate(p, radius, accuracy);
  return {-all.value, all.error};
}

bool Inside::decide_voxel(Vec3 p, int winding) const {
  for (const double accuracy : accuracies) {
    const WindingEstimate off = excess(p, 0, accuracy);
    if (off_integer(off.value + 0.5) > off.error) return winding > off.value + 0.5;
  }
  return tree_.winding_number(p, 0) > 0.5;
}

void Inside::decide(const Tile& tile, int first, std::span<const std::int16_t> winding,
                    std::span<std::uint8_t> inside) const {
  const std::array<int, 3>&low = tile.low, &high = tile.high;
  const auto each = [&](const auto& visit) {
    for (int k = low[2]; k < high[2]; ++k)
      for (int j = low[1]; j < high[1]; ++j)
        for (int i = low[0]; i < high[0]; ++i) visit(i, j, k, grid_.index(i, j, k - first));
  };
  const Vec3 corner = grid_.centre(low[0], low[1], low[2]);
  const Vec3 other = grid_.centre(high[0] - 1, high[1] - 1, high[2] - 1);
  const WindingEstimate off = excess(0.5 * (corner + other), 0.5 * norm(other - corner), 2);
  if (off_integer(off.value + 0.5) > off.error) {
    each(
        [&](int, int, int, std::size_t at) { inside[at] = winding[at] > off.value + 0.5 ? 1 : 0; });
    return;
  }
  const int edge = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  if (edge <= least_edge) {
    each([&](int i, int j, int k, std::size_t at) {
      inside[at] = decide_voxel(grid_.centre(i, j, k), winding[at]) ? 1 : 0;
    });
    return;
  }
  const int half = edge / 2;
  for (int k = low[2]; k < high[2]; k += half)
    for (int j = low[1]; j < high[1]; j += half)
      for (int i = low[0]; i < high[0]; i += half)
        decide({{i, j, k},
                {std::min(i + half, high[0]), std::min(j + half, high[1]),
                 std::min(k + half, high[2])}},
               first, winding, inside);
}

void Inside::layers(int first, int last, std::span<std::uint8_t> inside) const {
  const auto layer = static_cast<std::size_t>(grid_.n[0]) * static_cast<std::size_t>(grid_.n[1]);
  std::vector<std::int16_t> winding(inside.size(), 0);
  if (lines_)
    for (int k = first; k < last; ++k)
      lines_->layer(k,
                    std::span(winding).subspan(static_cast<std::size_t>(k - first) * layer, layer));
  if (lines_ && !caps_) {
    for (std::size_t at = 0; at < inside.size(); ++at) inside[at] = winding[at] > 0 ? 1 : 0;
  } else {
    for (int k = first; k < last; k += tile_edge)
      for (int j = 0; j < grid_.n[1]; j += tile_edge)
        for (int i = 0; i < grid_.n[0]; i += tile_edge)
          decide({{i, j, k},
                  {std::min(i + tile_edge, grid_.n[0]), std::min(j + tile_edge, grid_.n[1]),
                   std::min(k + tile_edge, last)}},
                 first, winding, inside);
  }
  for (int k = first; k < last; ++k)
    for (int j = 0; j < grid_.n[1]; ++j)
      for (int i = 0; i < grid_.n[0]; ++i)
        if (const auto at = grid_.index(i, j, k - first); winding[at] == WindingLines::unknown)
          inside[at] = tree_.is_inside(grid_.centre(i, j, k)) ? 1 : 0;
}

}  // namespace tess::dn
