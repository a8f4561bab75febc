#include "apps/overset/wall_study.hpp"

#include "apps/overset/body.hpp"
#include "m2m/overset.hpp"
#include "runtime/core/check.hpp"

#include <cmath>
#include <ctime>
#include <fmt/format.h>
#include <numbers>
#include <random>

namespace overset {
namespace {

using tess::m2m::cross;
using tess::m2m::difference;
using tess::m2m::dot;
using Triangles = std::vector<std::array<VertexId, 3>>;

/// The sum of the solid angles over 4π (van Oosterom and Strackee 1983).
double winding_by_angles(const std::vector<Point>& points, const Triangles& triangles,
                         const Point& p) {
  double sum = 0;
  for (const auto& t : triangles) {
    std::array<Point, 3> r{};
    std::array<double, 3> length{};
    for (std::size_t i = 0; i < 3; ++i) {
      r[i] = difference(points[static_cast<std::size_t>(t[i])], p);
      length[i] = std::sqrt(dot(r[i], r[i]));
    }
    const auto& [a, b, c] = r;
    const Point normal = cross(b, c);
    sum +=
        2 * std::atan2(dot(a, normal), length[0] * length[1] * length[2] + dot(a, b) * length[2] +
                                           dot(b, c) * length[0] + dot(c, a) * length[1]);
  }
  return sum / (4 * std::numbers::pi);
}

double seconds_since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

constexpr kit::Column<WallRow> columns[] = {
    {"triangles", "triangles", "10", kit::of<&WallRow::n_triangles>},
    {"build_seconds", "build, s", "10.4f", kit::of<&WallRow::build>},
    {"ns_per_point", "ns per point", "14.0f", kit::of<&WallRow::ns>},
    {"inside", "inside", "9", kit::of<&WallRow::n_inside>}};

}  // namespace

std::vector<WallRow> wall_study(const std::string& shape) {
  constexpr std::size_t n_points = 1'000'000, n_checked = 200;
  std::vector<WallRow> rows;
  for (const std::int32_t n : {4, 12, 30, 92}) {
    Body body = parse_body(fmt::format("{}:{}", shape, n));
    body.n_layers = 1;
    const std::vector<Point> places = mesh_around(body).points;
    const Triangles triangles = surface_of(body);
    std::clock_t start = std::clock();
    const tess::m2m::Wall wall(places, triangles);
    const double build = seconds_since(start);
    const tess::m2m::Aabb box = wall.box();
    std::mt19937_64 random(1);
    std::vector<Point> points(n_points);
    for (Point& p : points)
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = std::uniform_real_distribution<>(box.lo[k], box.hi[k])(random);
    std::size_t n_inside = 0;
    start = std::clock();
    for (const Point& p : points)
      if (wall.locate(p) != tess::m2m::Containment::outside) ++n_inside;
    const double seconds = seconds_since(start);
    for (std::size_t i = 0; i < n_checked; ++i) {
      const double angles = winding_by_angles(places, triangles, points[i]);
      TESS_CHECK(std::abs(angles - wall.winding_number(points[i])) < 1e-6, "the winding number is ",
                 wall.winding_number(points[i]), ", but the solid angles give ", angles);
    }
    rows.push_back({wall.n_triangles(), build, 1e9 * seconds / n_points, n_inside});
  }
  return rows;
}

const kit::Rows<WallRow>& wall_report() {
  static const kit::Rows<WallRow> report(columns);
  return report;
}

}  // namespace overset
