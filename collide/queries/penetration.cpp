#include "collide/penetration.hpp"

#include "collide/shapes/orientation.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/sort_unique.hpp"

#include <tuple>

namespace tess::collide {
namespace {

using shapes::Dropped;

/// The side of a + b seen along x at which `p` is, moved by e in y and e² in z for an infinitesimal e.
/// 0 only for an edge that has no length seen along x.
int moved_side(const Point& a, const Point& b, const Point& p) noexcept {
  if (const int side = shapes::orient2d(a, b, p, Dropped::x); side != 0) return side;
  if (a[2] != b[2]) return a[2] > b[2] ? 1 : -1;
  if (a[1] != b[1]) return b[1] > a[1] ? 1 : -1;
  return 0;
}

/// 1 where the ray from `p` along x leaves through the triangle, -1 where it enters, otherwise 0.
int crossing(const Triangle& t, const Point& p) noexcept {
  const auto& [a, b, c] = t.corners;
  const int turn = moved_side(a, b, p);
  if (turn == 0 || moved_side(b, c, p) != turn || moved_side(c, a, p) != turn) return 0;
  return shapes::orient3d(a, b, c, p) == -turn ? turn : 0;
}

/// Whether no coordinate of `p` is further than `length` outside of the box.
bool is_within(const Aabb& box, const Point& p, double length) noexcept {
  for (std::size_t k = 0; k < 3; ++k)
    if (box.lo[k] - p[k] > length || p[k] - box.hi[k] > length) return false;
  return true;
}

struct Edge {
  Point low, high;         // in lexicographic order
  int direction;           // 1 from low to high
  std::uint32_t triangle;  // position
};

void check_closed(std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const Point &from = triangles[t].corners[i], &to = triangles[t].corners[(i + 1) % 3];
      if (from < to) edges.push_back({from, to, 1, t});
      if (to < from) edges.push_back({to, from, -1, t});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  for (std::size_t i = 0; i < edges.size();) {
    const Edge& first = edges[i];
    int surplus = 0;
    for (; i < edges.size() && edges[i].low == first.low && edges[i].high == first.high; ++i)
      surplus += edges[i].direction;
    if (surplus == 0) continue;
    const Point &p = first.low, &q = first.high;
    fail(ErrorCode::bad_mesh, "the surface is not closed: the edge of triangle ", first.triangle,
         " between (", p[0], ", ", p[1], ", ", p[2], ") and (", q[0], ", ", q[1], ", ", q[2],
         ") has no opposite edge; close holes, weld equal corners, orient triangles alike");
  }
}

}  // namespace

ClosedModel::ClosedModel(std::span<const Triangle> triangles) : triangles_(triangles) {
  check_closed(triangles);
}

int ClosedModel::winding_number(const Point& p) const {
  detail::check_point(p);
  int sum = 0;
  triangles_.for_each(
      [&](const Aabb& box) {
        return box.hi[0] >= p[0] && box.lo[1] <= p[1] && box.hi[1] >= p[1] && box.lo[2] <= p[2] &&
               box.hi[2] >= p[2];
      },
      [&](std::uint32_t, const Triangle& t) { sum += crossing(t, p); });
  return sum;
}

std::optional<Penetration> ClosedModel::penetration(const Point& p) const {
  if (winding_number(p) == 0) return std::nullopt;
  const Neighbour nearest = triangles_.nearest(p, 1).front();
  Penetration out{HUGE_VAL, p, {}, nearest.object};
  const auto look_at = [&](std::uint32_t triangle, const Triangle& t) {
    const Point way = offset_to(t, p);
    const double depth = std::hypot(way[0], way[1], way[2]);
    if (std::tie(depth, triangle) <= std::tie(out.depth, out.triangle))
      out = {depth, p, way, triangle};
  };
  look_at(nearest.object, triangles_.object(nearest.object));
  // A squared distance beyond these may have lost which triangle is nearest.
  if (nearest.distance2 < 1e-290 || nearest.distance2 == HUGE_VAL)
    triangles_.for_each([&](const Aabb& box) { return is_within(box, p, out.depth); }, look_at);
  if (out.depth == 0) return std::nullopt;
  for (std::size_t k = 0; k < 3; ++k) {
    out.nearest[k] += out.direction[k];
    out.direction[k] /= out.depth;
  }
  return out;
}

std::vector<PenetratingPoint> penetrating_points(std::span<const Triangle> triangles,
                                                 std::span<const std::uint32_t> which,
                                                 const ClosedModel& model) {
  std::vector<Point> points;
  points.reserve(3 * which.size());
  for (const std::uint32_t t : which) {
    if (t >= triangles.size())
      fail(ErrorCode::bad_value, "a triangle at position ", t, " of ", triangles.size(),
           " is asked for penetration; positions count from 0");
    points.insert(points.end(), triangles[t].corners.begin(), triangles[t].corners.end());
  }
  sort_unique(points);
  std::vector<PenetratingPoint> out;
  for (const Point& p : points)
    if (const std::optional<Penetration> found = model.penetration(p)) out.push_back({p, *found});
  return out;
}

}  // namespace tess::collide
