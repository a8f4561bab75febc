#include "m2m/overset/wall.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tess::m2m {
namespace {

/// The power of two that brings the largest coordinate to [1/2, 1).
double scale_of(std::span<const Point> points) {
  double largest = 0;
  for (std::size_t v = 0; v < points.size(); ++v)
    for (const double x : points[v]) {
      if (!(std::abs(x) <= 1e100))
        fail(ErrorCode::bad_mesh, "point ", v, " of the wall has the coordinate ", x,
             "; coordinates must be finite and at most 1e100");
      largest = std::max(largest, std::abs(x));
    }
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::ldexp(1, -exponent);
}

/// Per point: the lowest point at the same place.
std::vector<VertexId> firsts_of(std::span<const Point> points) {
  std::vector<VertexId> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](VertexId v) -> const Point& { return points[static_cast<std::size_t>(v)]; };
  std::sort(order.begin(), order.end(),
            [&](VertexId a, VertexId b) { return at(a) < at(b) || (at(a) == at(b) && a < b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_new = i == 0 || at(order[i]) != at(order[i - 1]);
    first[static_cast<std::size_t>(order[i])] =
        is_new ? order[i] : first[static_cast<std::size_t>(order[i - 1])];
  }
  return first;
}

/// "(0, 0.5, 1)".
std::string place_of(const Point& p) {
  return text('(', p[0], ", ", p[1], ", ", p[2], ')');
}

}  // namespace

Wall::Wall(std::span<const Point> points, std::span<const std::array<VertexId, 3>> triangles,
           std::span<const SymmetryPlane> symmetry)
    : scale_(scale_of(points)) {
  std::vector<Point> at;
  for (const Point& p : points) at.push_back(scaled(p));
  const std::vector<VertexId> firsts = firsts_of(at);
  std::vector<std::array<VertexId, 3>> whole;
  std::vector<std::size_t> numbers;  // of the triangles in `whole`
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<VertexId, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId v = triangles[t][i];
      if (v < 0 || static_cast<std::size_t>(v) >= points.size())
        fail(ErrorCode::bad_mesh, "triangle ", t, " of the wall names point ", v, " of ",
             points.size());
      corners[i] = firsts[static_cast<std::size_t>(v)];
    }
    const auto& [a, b, c] = corners;
    if (a == b || b == c || c == a) continue;
    whole.push_back(corners);
    numbers.push_back(t);
  }
  if (whole.empty())
    fail(ErrorCode::bad_mesh, "the wall has no triangle with an area; give the surface of a body");
  std::vector<SymmetryPlane> planes(symmetry.begin(), symmetry.end());
  for (SymmetryPlane& plane : planes) plane.offset *= scale_, plane.tolerance *= scale_;
  rim_ = close(at, whole, planes);
  if (rim_.cap_share > most_capped || rim_.leaves_at >= 0) {
    if (const auto turned = same_direction(std::span(whole).first(numbers.size()))) {
      const auto& [one, other] = turned->triangles;
      const Point &p = points[static_cast<std::size_t>(turned->edge.first)],
                  &q = points[static_cast<std::size_t>(turned->edge.second)];
      fail(ErrorCode::bad_mesh, "the triangles of the wall are not oriented alike: triangles ",
           numbers[one], " and ", numbers[other], " (from 0) pass their edge between ", place_of(p),
           " and ", place_of(q),
           " in the same direction; turn triangles until all normals point outwards");
    }
    if (rim_.leaves_at >= 0)
      fail(ErrorCode::bad_mesh, "a hole of the wall lies in a plane of symmetry in part only: at ",
           place_of(points[static_cast<std::size_t>(rim_.leaves_at)]), " it leaves ",
           text_of(symmetry), "; give all planes of symmetry, or move its points onto them");
    fail(ErrorCode::bad_mesh, "the wall is open: caps on its ", rim_.n_loops, " holes with ",
         rim_.n_edges, " edges are ", rim_.cap_share, " of the area, at most ", most_capped,
         " is allowed; close the holes, merge points that should be one, or give the planes of "
         "symmetry that they lie in");
  }
  if (rim_.between >= 0)
    fail(ErrorCode::bad_mesh, "the hole of the wall at ",
         place_of(points[static_cast<std::size_t>(rim_.between)]),
         " lies in planes of symmetry that face each other, among ", text_of(symmetry),
         "; close the wall in one of them");
  for (const auto& corners : whole) {
    WallTriangle triangle{{}, corners};
    for (std::size_t i = 0; i < 3; ++i)
      triangle.corners[i] = at[static_cast<std::size_t>(corners[i])];
    triangles_.push_back(triangle);
  }
  build();
}

void Wall::build() {
  const auto box_of = [](const WallTriangle& t) { return collide::box_around(t.corners); };
  Aabb all = collide::no_box<double, 3>();
  for (const WallTriangle& t : triangles_) all = collide::merged(all, box_of(t));
  std::vector<Tree::Centre> centres(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Aabb box = box_of(triangles_[t]);
    centres[t].object = static_cast<std::uint32_t>(t);
    for (std::size_t k = 0; k < 3; ++k)
      centres[t].at[k] = static_cast<float>(0.5 * (box.lo[k] + box.hi[k]) - all.lo[k]);
  }
  tree_ = Tree(std::move(centres));
  std::vector<WallTriangle> by_place(triangles_.size());
  for (std::size_t i = 0; i < by_place.size(); ++i) by_place[i] = triangles_[tree_.object(i)];
  triangles_ = std::move(by_place);
  const auto nodes = tree_.nodes();
  for (std::size_t n = nodes.size(); n-- > 0;) {
    auto& node = nodes[n];
    node.box = collide::no_box<double, 3>();
    if (node.count == 0)
      node.box = collide::merged(nodes[node.first].box, nodes[node.first + 1].box);
    Tree::each_place(node, [&](std::uint32_t i) {
      node.box = collide::merged(node.box, box_of(triangles_[i]));
    });
  }
}

Wall::Sum Wall::sum(const Point& p) const {
  Sum out;
  tree_.descend([&](std::uint32_t at) {
    const Tree::Node& node = tree_.nodes()[at];
    const Aabb& box = node.box;
    if (p[0] > box.hi[0] || p[1] < box.lo[1] || p[1] > box.hi[1] || p[2] < box.lo[2] ||
        p[2] > box.hi[2])
      return false;
    Tree::each_place(node, [&](std::uint32_t i) {
      const WallTriangle& triangle = triangles_[i];
      if (p[0] >= box.lo[0] && is_on(p, triangle))
        out.is_on_wall = true;
      else
        out.winding += crossing(p, triangle);
    });
    return true;
  });
  return out;
}

Containment Wall::locate(const Point& p) const {
  const Sum sum = this->sum(scaled(p));
  if (sum.is_on_wall) return Containment::on_wall;
  return sum.winding != 0 ? Containment::inside : Containment::outside;
}

int Wall::winding_number(const Point& p) const {
  return sum(scaled(p)).winding;
}

Wall Wall::seen_from(const Aabb& box) const {
  const Point low = scaled(box.lo), high = scaled(box.hi);
  Wall out;
  out.scale_ = scale_;
  out.rim_ = rim_;
  for (const WallTriangle& t : triangles_) {
    const Aabb mine = collide::box_around(t.corners);
    if (mine.hi[0] >= low[0] && mine.hi[1] >= low[1] && mine.lo[1] <= high[1] &&
        mine.hi[2] >= low[2] && mine.lo[2] <= high[2])
      out.triangles_.push_back(t);
  }
  out.build();
  return out;
}

Aabb Wall::box() const {
  if (triangles_.empty()) return collide::no_box<double, 3>();
  Aabb box = tree_.nodes()[0].box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] /= scale_;
    box.hi[k] /= scale_;
  }
  return box;
}

}  // namespace tess::m2m
