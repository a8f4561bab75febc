#include "apps/overset/body.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

namespace overset {
namespace {

using tess::collide::length;
using tess::m2m::Tet;
using tess::m2m::TetMesh;
using Triangle = std::array<VertexId, 3>;

constexpr std::array<std::pair<std::string_view, Body::Shape>, 4> shapes{
    {{"ball", Body::Shape::ball},
     {"box", Body::Shape::box},
     {"star", Body::Shape::star},
     {"torus", Body::Shape::torus}}};

/// The points of a shape before it is scaled, turned and moved: innermost and outermost place of
/// each.
struct Skeleton {
  std::vector<std::pair<Point, Point>> points;
  std::vector<Triangle> triangles;  // normals outwards
};

/// The distance of the surface from the centre in a direction, of length 1.
double reach(Body::Shape shape, const Point& d) {
  switch (shape) {
    case Body::Shape::box:
      return 1 / std::max({std::abs(d[0]) / 0.9, std::abs(d[1]) / 0.7, std::abs(d[2]) / 0.5});
    case Body::Shape::star:
      return 0.7 + 0.3 * std::cos(5 * std::atan2(d[1], d[0])) * (1 - d[2] * d[2]);
    default:
      return 1;
  }
}

/// The surface of a cube of n³ cubes, seen from its centre.
Skeleton star_shaped(const Body& body) {
  Skeleton out;
  std::map<std::array<std::int32_t, 3>, VertexId> number;
  const auto vertex = [&](const std::array<std::int32_t, 3>& cube) {
    const auto [at, is_new] = number.emplace(cube, static_cast<VertexId>(out.points.size()));
    if (is_new) {
      Point d{};
      for (std::size_t k = 0; k < 3; ++k) d[k] = 2.0 * cube[k] / body.n - 1;
      const double size = length(d);
      for (double& x : d) x /= size;
      const double r = reach(body.shape, d);
      const auto times = [&](double by) { return Point{by * d[0], by * d[1], by * d[2]}; };
      out.points.push_back({times(r), times(r * body.outer)});
    }
    return at->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const std::int32_t at : {0, body.n})
      for (std::int32_t u = 0; u < body.n; ++u)
        for (std::int32_t v = 0; v < body.n; ++v) {
          const auto corner = [&](std::int32_t du, std::int32_t dv) {
            std::array<std::int32_t, 3> cube{};
            cube[axis] = at;
            cube[(axis + 1) % 3] = u + du;
            cube[(axis + 2) % 3] = v + dv;
            return vertex(cube);
          };
          Triangle a{corner(0, 0), corner(1, 0), corner(1, 1)};
          Triangle b{corner(0, 0), corner(1, 1), corner(0, 1)};
          if (at == 0) std::swap(a[1], a[2]), std::swap(b[1], b[2]);
          out.triangles.push_back(a);
          out.triangles.push_back(b);
        }
  return out;
}

Skeleton torus(const Body& body) {
  constexpr double tube = 0.35;
  Skeleton out;
  const std::int32_t n_around = 3 * body.n, n_tube = 2 * body.n;
  const auto angle = [](std::int32_t i, std::int32_t n) { return 2 * std::numbers::pi * i / n; };
  for (std::int32_t i = 0; i < n_around; ++i)
    for (std::int32_t k = 0; k < n_tube; ++k) {
      const double a = angle(i, n_around), b = angle(k, n_tube);
      const auto place = [&](double r) {
        const double from_axis = 1 - tube + r * std::cos(b);
        return Point{from_axis * std::cos(a), from_axis * std::sin(a), r * std::sin(b)};
      };
      // The outer tube stays clear of the axis.
      out.points.push_back({place(tube), place(std::min(tube * body.outer, 0.9 * (1 - tube)))});
    }
  const auto at = [&](std::int32_t i, std::int32_t k) {
    return (i % n_around) * n_tube + k % n_tube;
  };
  for (std::int32_t i = 0; i < n_around; ++i)
    for (std::int32_t k = 0; k < n_tube; ++k) {
      out.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      out.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return out;
}

/// The part on one side of the planes through the centre.
Skeleton cut(Skeleton all, const std::array<std::int32_t, 3>& half) {
  constexpr double rounding = 1e-12;
  Skeleton out;
  std::map<VertexId, VertexId> number;
  const auto at = [&](VertexId v) -> auto& { return all.points[static_cast<std::size_t>(v)]; };
  for (const Triangle& triangle : all.triangles) {
    bool is_beyond = false;
    for (std::size_t k = 0; k < 3; ++k) {
      double low = 0, high = 0;
      for (const VertexId v : triangle) {
        auto& [inner, outer] = at(v);
        if (std::abs(inner[k]) < rounding) inner[k] = outer[k] = 0;
        low = std::min(low, half[k] * inner[k]);
        high = std::max(high, half[k] * inner[k]);
      }
      if (low < 0 && high > 0)
        tess::fail(tess::ErrorCode::bad_argument, "a triangle of the body crosses the plane of ",
                   "symmetry across ", "xyz"[k], "; give an even number, for a torus 4, 8, …");
      is_beyond = is_beyond || low < 0;
    }
    if (is_beyond) continue;
    out.triangles.push_back(triangle);
    for (const VertexId v : triangle) number[v] = 0;
  }
  for (auto& [old, now] : number) {
    now = static_cast<VertexId>(out.points.size());
    out.points.push_back(at(old));
  }
  for (Triangle& triangle : out.triangles)
    for (VertexId& v : triangle) v = number[v];
  return out;
}

Skeleton skeleton_of(const Body& body) {
  return cut(body.shape == Body::Shape::torus ? torus(body) : star_shaped(body), body.half);
}

Point placed(const Body& body, Point p) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double c = std::cos(body.turn[axis]), s = std::sin(body.turn[axis]);
    double &u = p[(axis + 1) % 3], &v = p[(axis + 2) % 3];
    std::tie(u, v) = std::pair(c * u - s * v, s * u + c * v);
  }
  for (std::size_t k = 0; k < 3; ++k) p[k] = body.centre[k] + body.radius * p[k];
  return p;
}

}  // namespace

bool names_shape(std::string_view name) {
  return std::any_of(shapes.begin(), shapes.end(),
                     [&](const auto& shape) { return name == shape.first; });
}

bool names_body(std::string_view name) {
  return std::any_of(shapes.begin(), shapes.end(), [&](const auto& shape) {
    return name.starts_with(shape.first) && name.substr(shape.first.size()).starts_with(':');
  });
}

Body parse_body(std::string_view name, std::span<const tess::m2m::SymmetryPlane> symmetry) {
  Body body;
  const std::size_t colon = std::min(name.find(':'), name.size() - 1);
  const std::size_t end = std::min(name.find('@'), name.size());
  for (const auto& [word, shape] : shapes)
    if (name.substr(0, colon) == word) body.shape = shape;
  const std::string_view size = name.substr(colon + 1, end - std::min(end, colon + 1));
  body.n = tess::parse_number<decltype(body.n)>(size).value_or(0);
  if (body.shape == Body::Shape::torus) body.radius = 0.32;
  if (body.n < 2 || body.n > 200)
    tess::fail(tess::ErrorCode::bad_argument, name, ": give a number from 2 to 200, as in ball:12");
  for (auto plane : symmetry) {
    plane.tolerance = HUGE_VAL;
    tess::m2m::project({&body.centre, 1}, {&plane, 1});
  }
  std::vector<double> place;
  for (std::string_view text = name.substr(end); !text.empty();) {
    text.remove_prefix(1);
    const auto number = tess::take_number<double>(text);
    if (!number || !std::isfinite(*number) || !(text.empty() || text[0] == ':')) place.resize(9);
    if (place.size() > 4) break;
    place.push_back(*number);
  }
  if (end < name.size() &&
      (place.size() < 3 || place.size() > 4 || !(place.back() > 0 || place.size() == 3)))
    tess::fail(tess::ErrorCode::bad_argument, name,
               ": after @ give a centre, or a centre and a radius, as in ball:12@0.5:0.5:0:0.2");
  if (place.size() > 2) body.centre = {place[0], place[1], place[2]};
  if (place.size() > 3) body.radius = place[3];
  for (const auto& plane : symmetry) {
    if (!plane.holds(body.centre)) continue;
    const auto axis = std::find_if(plane.normal.begin(), plane.normal.end(),
                                   [](double x) { return std::abs(x) == 1; });
    if (axis == plane.normal.end())
      tess::fail(tess::ErrorCode::bad_argument, name, ": a generated body cannot be cut at ",
                 text_of(plane), "; give a plane across an axis, or a centre that is not in it");
    body.half[static_cast<std::size_t>(axis - plane.normal.begin())] = *axis > 0 ? 1 : -1;
    body.turn = {};
  }
  return body;
}

std::vector<std::array<VertexId, 3>> surface_of(const Body& body) {
  return skeleton_of(body).triangles;
}

TetMesh mesh_around(const Body& body) {
  const Skeleton skeleton = skeleton_of(body);
  const std::int32_t n_layers = body.n_layers > 0 ? body.n_layers : std::max(2, body.n / 2);
  const auto n = static_cast<VertexId>(skeleton.points.size());
  TetMesh mesh;
  mesh.name = "generated";
  for (std::int32_t k = 0; k <= n_layers; ++k)
    for (const auto& [inner, outer] : skeleton.points) {
      const double t = static_cast<double>(k) / n_layers;
      Point p{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = (1 - t) * inner[axis] + t * outer[axis];
      mesh.points.push_back(placed(body, p));
    }
  for (std::int32_t k = 0; k < n_layers; ++k)
    for (const Triangle& triangle : skeleton.triangles) {
      // The diagonal of a prism's side goes up from its lower corner, so that neighbours agree.
      Triangle low = triangle;
      const bool is_odd = (low[0] < low[1]) + (low[1] < low[2]) + (low[2] < low[0]) == 1;
      std::sort(low.begin(), low.end());
      for (VertexId& v : low) v += k * n;
      for (Tet tet :
           {Tet{low[0], low[1], low[2], low[2] + n}, Tet{low[0], low[1], low[2] + n, low[1] + n},
            Tet{low[0], low[0] + n, low[1] + n, low[2] + n}}) {
        if (is_odd) std::swap(tet[2], tet[3]);
        mesh.tets.push_back(tet);
      }
    }
  return mesh;
}

}  // namespace overset
