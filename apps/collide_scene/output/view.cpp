#include "apps/collide_scene/output/view.hpp"

#include <algorithm>
#include <cmath>

namespace collide_scene {
namespace {
using tess::collide::Aabb;
using tess::collide::cross;
using tess::collide::difference;
using tess::collide::dot;
using tess::collide::Point;

// From the side of negative x and y, 32 degrees above the plane: three unit vectors.
constexpr double cosine = 0.848048096156426, sine = 0.529919264233205;  // of 32 degrees
constexpr double c = 0.819152044288992, s = 0.573576436351046;          // of 35 degrees
constexpr Point u{c, -s, 0}, v{sine * s, sine* c, cosine}, w{-cosine * s, -cosine* c, sine};
constexpr Point light{-0.25, -0.45, 0.857};  // about a unit vector, towards the light

/// Calls use(a, b, c, object) for each triangle of the scene and each half of a box's face.
template <class Use>
void for_each_triangle(const Scene& scene, Use&& use) {
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const auto& [p, q, r] = scene.triangles[t].corners;
    use(p, q, r, t);
  }
  for (std::size_t b = 0; b < scene.boxes.size(); ++b)
    for (const auto& [p, q, r, last] : faces_of(scene.boxes[b])) {
      use(p, q, r, scene.triangles.size() + b);
      use(p, r, last, scene.triangles.size() + b);
    }
}

}  // namespace

std::array<std::array<Point, 4>, 6> faces_of(const Aabb& box) {
  // Corners by the bits of their place: 1 for the upper x, 2 for y, 4 for z.
  constexpr std::array<std::array<unsigned, 4>, 6> faces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  std::array<std::array<Point, 4>, 6> out{};
  for (std::size_t f = 0; f < 6; ++f)
    for (std::size_t i = 0; i < 4; ++i)
      for (unsigned k = 0; k < 3; ++k)
        out[f][i][k] = (faces[f][i] >> k & 1U) != 0 ? box.hi[k] : box.lo[k];
  return out;
}

View::View(const Scene& scene, int n_pixels) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  // Coordinates from a corner of the scene: a scene may be far from the origin.
  Aabb bounds{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (const Aabb& box : boxes_of(scene)) bounds = merged(bounds, box);
  double least_x = inf, greatest_x = -inf, least_y = inf, greatest_y = -inf;
  for_each_triangle(scene, [&](const Point& p, const Point& q, const Point& r, std::size_t object) {
    Seen& seen = triangles_.emplace_back();
    seen.object = static_cast<std::uint32_t>(object);
    std::array<Point, 3> from{p, q, r};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) from[i][k] -= bounds.lo[k];
      seen.x[i] = dot(u, from[i]);
      seen.y[i] = -dot(v, from[i]);
      seen.depth[i] = dot(w, from[i]);
      least_x = std::min(least_x, seen.x[i]);
      greatest_x = std::max(greatest_x, seen.x[i]);
      least_y = std::min(least_y, seen.y[i]);
      greatest_y = std::max(greatest_y, seen.y[i]);
    }
    Point normal = cross(difference(from[1], from[0]), difference(from[2], from[0]));
    if (dot(normal, w) < 0) normal = {-normal[0], -normal[1], -normal[2]};
    const double length = std::sqrt(dot(normal, normal));
    seen.light =
        length > 0 ? static_cast<float>(std::clamp(dot(normal, light) / length, 0.0, 1.0)) : 0.5F;
  });
  const double longest = std::max(greatest_x - least_x, greatest_y - least_y);
  const double scale = longest > 0 ? (n_pixels - 2) / longest : 1;
  const auto pixels = [&](double extent) {
    return triangles_.empty() ? 1 : std::max(1, static_cast<int>(std::ceil(extent * scale)) + 2);
  };
  corner_ = bounds.lo;
  left_ = least_x, top_ = least_y, scale_ = scale;
  width_ = pixels(greatest_x - least_x);
  height_ = pixels(greatest_y - least_y);
  const auto n = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  nearest_.assign(n, nothing);
  depth_.assign(n, -std::numeric_limits<float>::infinity());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      triangles_[t].x[i] = 1 + (triangles_[t].x[i] - least_x) * scale;
      triangles_[t].y[i] = 1 + (triangles_[t].y[i] - least_y) * scale;
    }
    draw(t);
  }
}

kit::Point View::pixel(const Point& p) const {
  const Point from = difference(p, corner_);
  return {1 + (dot(u, from) - left_) * scale_, 1 + (-dot(v, from) - top_) * scale_};
}

void View::draw_at(int x, int y, double depth, std::uint32_t number) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  const std::size_t i =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  if (static_cast<float>(depth) <= depth_[i]) return;
  depth_[i] = static_cast<float>(depth);
  nearest_[i] = number;
}

void View::draw(std::uint32_t number) {
  const auto& [x, y, depth, object, lit] = triangles_[number];
  // A triangle that is smaller than a pixel is seen at its corners.
  for (std::size_t i = 0; i < 3; ++i)
    draw_at(static_cast<int>(x[i]), static_cast<int>(y[i]), depth[i], number);
  const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (area == 0) return;
  const auto [left, right] = std::minmax({x[0], x[1], x[2]});
  const auto [top, bottom] = std::minmax({y[0], y[1], y[2]});
  for (int row = static_cast<int>(top); row <= static_cast<int>(bottom); ++row)
    for (int column = static_cast<int>(left); column <= static_cast<int>(right); ++column) {
      const double px = column + 0.5, py = row + 0.5;
      const double b = ((px - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (py - y[0])) / area;
      const double d = ((x[1] - x[0]) * (py - y[0]) - (px - x[0]) * (y[1] - y[0])) / area;
      if (b < 0 || d < 0 || b + d > 1) continue;
      draw_at(column, row, (1 - b - d) * depth[0] + b * depth[1] + d * depth[2], number);
    }
}

std::vector<std::uint32_t> View::visible() const {
  std::vector<std::uint32_t> numbers;
  for (const std::uint32_t number : nearest_)
    if (number != nothing) numbers.push_back(number);
  std::ranges::sort(numbers);
  const auto rest = std::ranges::unique(numbers);
  numbers.erase(rest.begin(), rest.end());
  std::ranges::sort(numbers, [&](std::uint32_t a, std::uint32_t b) {
    const double da = triangles_[a].mean_depth(), db = triangles_[b].mean_depth();
    return da != db ? da < db : a < b;
  });
  return numbers;
}

}  // namespace collide_scene
