// A parallel projection of a scene onto a raster that keeps the nearest triangle of each pixel.
//
//     w: towards the viewer        up ▲ v
//     ╲                               │
//      scene                          └──► u
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"
#include "apps/kit/output/chart.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace collide_scene {

/// The corners of the six faces of a box, in order around each.
[[nodiscard]] std::array<std::array<tess::collide::Point, 4>, 6> faces_of(
    const tess::collide::Aabb& box);

/// A triangle in pixels, y downwards; `depth` grows towards the viewer.
struct Seen {
  std::array<double, 3> x{}, y{}, depth{};
  std::uint32_t object = 0;
  float light = 0;  ///< 0 … 1: how much it faces the light

  [[nodiscard]] double mean_depth() const { return (depth[0] + depth[1] + depth[2]) / 3; }
};

class View {
 public:
  static constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();

  /// Projects all triangles and faces of boxes, and draws them into the raster. The longer side of
  /// the scene takes `n_pixels`.
  View(const Scene& scene, int n_pixels);

  /// Where a point of space is seen.
  [[nodiscard]] kit::Point pixel(const tess::collide::Point& p) const;
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const std::vector<Seen>& triangles() const { return triangles_; }
  /// The number of the triangle that a pixel shows, or `nothing`.
  [[nodiscard]] std::uint32_t at(int x, int y) const {
    return nearest_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x)];
  }
  /// The numbers of the triangles that some pixel shows, from the farthest to the nearest.
  [[nodiscard]] std::vector<std::uint32_t> visible() const;

 private:
  void draw(std::uint32_t number);
  void draw_at(int x, int y, double depth, std::uint32_t number);

  int width_ = 1, height_ = 1;
  tess::collide::Point corner_{};  // of the scene
  double left_ = 0, top_ = 0, scale_ = 1;
  std::vector<Seen> triangles_;
  std::vector<std::uint32_t> nearest_;
  std::vector<float> depth_;
};

}  // namespace collide_scene
