#include "collide/dn_field/orientation.hpp"

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/geometry/surface_edges.hpp"

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>

namespace tess::dn {
namespace {
constexpr double no_volume = 1e-12;      // of the cube of a part's diagonal: rounding
constexpr std::size_t max_samples = 16;  // triangles at which a part's winding is sampled
constexpr double beside = 1e-5;          // of a triangle's size: offset of the samples from it
constexpr double accuracy = 4;           // the means are ±1/2: an error of 0.1 is harmless

/// A connected part of a surface.
struct Part {
  Bounds box;
  double volume = 0;  // signed
  bool open = false;
  std::vector<std::uint32_t> triangles = {};
};

/// The connected parts of `surface`, by their lowest vertex.
std::vector<Part> parts_of(const Surface& surface, bool closed) {
  const std::size_t n = surface.vertices.size();
  boost::disjoint_sets_with_storage<> sets(n);
  for (const auto& [a, b, c] : surface.triangles) sets.union_set(a, b), sets.union_set(a, c);
  std::vector<std::size_t> number(n), part_of_set(n, n);
  std::vector<Part> parts;
  for (std::size_t v = 0; v < n; ++v) {
    std::size_t& part = part_of_set[sets.find_set(v)];
    if (part == n) part = parts.size(), parts.emplace_back();
    number[v] = part;
    parts[part].box.extend(surface.vertices[v]);
  }
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    Part& part = parts[number[surface.triangles[t][0]]];
    const Vec3 middle = part.box.centre();
    const auto [a, b, c] = surface.corners(t);
    part.volume += dot(a - middle, cross(b - middle, c - middle)) / 6;
    part.triangles.push_back(t);
  }
  if (!closed)
    each_edge(surface, [&](const EdgeUse& edge) {
      if ((edge.up + edge.down) % 2 != 0) parts[number[edge.low]].open = true;
    });
  return parts;
}

/// Whether the triangles of `part` are mostly turned inwards.
bool looks_inverted(const Part& part) {
  const double diagonal = norm(part.box.size());
  return part.volume < -no_volume * diagonal * diagonal * diagonal;
}

/// The sum of the winding numbers of `surface` on both sides of samples of `part`.
double winding_on(const Part& part, const Surface& surface, const Bvh& tree) {
  const std::size_t n = part.triangles.size(), step = (n + max_samples - 1) / max_samples;
  double sum = 0;
  for (std::size_t i = 0; i < n; i += step) {
    const std::uint32_t t = part.triangles[i];
    if (norm(tree.normal(t)) == 0) continue;
    const auto [a, b, c] = surface.corners(t);
    const Vec3 middle = (1.0 / 3) * (a + b + c);
    const Vec3 off = beside * std::sqrt(norm(cross(b - a, c - a))) * tree.normal(t);
    sum +=
        tree.winding_number(middle + off, accuracy) + tree.winding_number(middle - off, accuracy);
  }
  return sum;
}

}  // namespace

OutwardSurface::OutwardSurface(const Surface& given)
    : given_(given), closed_(tess::dn::is_closed(given)) {
  if (!closed_) {
    own_ = welded(given);
    closed_ = tess::dn::is_closed(*own_);
  }
  const std::vector<Part> parts = parts_of(surface(), closed_);
  const auto may_turn = [](const Part& part) { return !part.open && looks_inverted(part); };
  if (std::none_of(parts.begin(), parts.end(), may_turn)) return;
  const Bvh tree(surface());
  Surface turned = surface();
  for (const Part& part : parts) {
    if (part.open || part.triangles.empty() || winding_on(part, surface(), tree) >= 0) continue;
    for (const std::uint32_t t : part.triangles)
      std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  }
  own_ = std::move(turned);
}

}  // namespace tess::dn
