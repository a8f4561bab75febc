// Cuts polygons into triangles inside of them: by ears (Meisters 1975, "Polygons have ears"), with
// exact signs in the plane of two axes that the polygon lies closest to.
#include "collide/dn_field/surface.hpp"
#include "collide/shapes/orientation.hpp"

#include <algorithm>
#include <utility>

namespace tess::dn {
namespace {

using collide::Point;

class Polygon {
 public:
  Polygon(const Surface& surface, std::span<const std::uint32_t> corners) {
    for (const std::uint32_t v : corners) {
      const Vec3 p = surface.vertices[v];
      points_.push_back({p.x, p.y, p.z});
    }
    project();
  }

  [[nodiscard]] bool is_flat() const { return is_flat_; }

  /// The fan from the first corner covers the polygon: each of its triangles has the polygon's
  /// orientation. In addition the polygon must not cross itself.
  [[nodiscard]] bool has_fan() const {
    for (std::size_t i = 2; i < points_.size(); ++i)
      if (turn(0, i - 1, i) < 0) return false;
    return true;
  }

  [[nodiscard]] bool is_convex() const {
    const std::size_t n = points_.size();
    int last = 0, n_reversals = 0;
    for (std::size_t i = 0; i < 2 * n; ++i) {  // the second round begins with a direction
      const std::size_t b = (i + 1) % n;
      if (turn(i % n, b, (i + 2) % n) < 0) return false;
      const double from = points_[i % n][first_axis()], to = points_[b][first_axis()];
      const int direction = static_cast<int>(to > from) - static_cast<int>(to < from);
      if (direction == 0) continue;
      n_reversals += static_cast<int>(i >= n && last != 0 && last != direction);
      last = direction;
    }
    return n_reversals <= 2;
  }

  [[nodiscard]] bool crosses_itself() const {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i + 2 < n; ++i)
      for (std::size_t k = i + 2; k < n; ++k)
        if (cross(i, i + 1, k, (k + 1) % n)) return true;
    return false;
  }

  /// The triangles, by the places of their corners; none if no ear is found.
  [[nodiscard]] std::vector<std::array<std::size_t, 3>> ears() const {
    std::vector<std::array<std::size_t, 3>> out;
    std::vector<std::size_t> ring(points_.size());
    for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = i;
    std::size_t at = 0;
    while (ring.size() > 3) {
      const std::size_t n = ring.size();
      std::size_t tried = 0;
      while (tried < n && !is_ear(ring, (at + tried) % n)) ++tried;
      at = (at + tried) % n;
      if (tried == n) {  // corners on a line with their neighbours come last
        at = 0;
        while (at < n && turn(ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]) != 0) ++at;
        if (at == n) return {};
      }
      out.push_back({ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]});
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
    }
    if (turn(ring[0], ring[1], ring[2]) < 0) return {};
    out.push_back({ring[0], ring[1], ring[2]});
    return out;
  }

 private:
  void project() {
    std::array<double, 3> sums{}, normal{};
    double extent = 0, largest = 0;
    const Point& origin = points_[0];
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const Point a = collide::difference(points_[i - 1], origin);
      const Point b = collide::difference(points_[i], origin);
      const Point product = collide::cross(a, b);
      for (std::size_t k = 0; k < 3; ++k) {
        normal[k] += product[k];
        sums[k] += std::abs(product[k]);  // the lobes of an eight cancel in the normal
        extent = std::max(extent, std::abs(b[k]));
        largest = std::max(largest, std::abs(points_[i][k]));
      }
    }
    const auto axis = static_cast<std::size_t>(std::ranges::max_element(sums) - sums.begin());
    dropped_ = static_cast<collide::shapes::Dropped>(axis);
    sign_ = normal[axis] < 0 ? -1 : 1;
    double low = 0, high = 0;
    for (const Point& p : points_) {
      const double height = collide::dot(collide::difference(p, origin), normal);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    const double tolerance = 1e-4 * extent + 0x1p-22 * largest;  // single precision rounds
    is_flat_ = high - low <= tolerance * collide::length(normal);
  }

  [[nodiscard]] std::size_t first_axis() const {
    return (static_cast<std::size_t>(dropped_) + 1) % 3;
  }
  [[nodiscard]] std::size_t second_axis() const {
    return (static_cast<std::size_t>(dropped_) + 2) % 3;
  }

  /// 1 if a, b, c turn in the direction of the polygon.
  [[nodiscard]] int turn(std::size_t a, std::size_t b, std::size_t c) const {
    return sign_ * orient2d(points_[a], points_[b], points_[c], dropped_);
  }

  [[nodiscard]] bool coincide(std::size_t a, std::size_t b) const {
    return points_[a][first_axis()] == points_[b][first_axis()] &&
           points_[a][second_axis()] == points_[b][second_axis()];
  }

  /// Whether the sides a b and c d cross in a point inside of both.
  [[nodiscard]] bool cross(std::size_t a, std::size_t b, std::size_t c, std::size_t d) const {
    for (const std::size_t axis : {first_axis(), second_axis()}) {
      const auto [ab_low, ab_high] = std::minmax(points_[a][axis], points_[b][axis]);
      const auto [cd_low, cd_high] = std::minmax(points_[c][axis], points_[d][axis]);
      if (ab_high < cd_low || cd_high < ab_low) return false;
    }
    return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
  }

  /// Whether the corner can be cut off: it is convex, no other corner lies in its triangle or on its
  /// edge, and, since a hole may be joined to the outline by a side there and back, no side from the
  /// same point leads through it.
  [[nodiscard]] bool is_ear(const std::vector<std::size_t>& ring, std::size_t at) const {
    const std::size_t n = ring.size();
    const std::size_t a = ring[(at + n - 1) % n], b = ring[at], c = ring[(at + 1) % n];
    if (turn(a, b, c) <= 0) return false;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t q = ring[i];
      if (q == a || q == b || q == c || coincide(q, a) || coincide(q, c)) continue;
      if (coincide(q, b)) {
        if (cross(ring[(i + n - 1) % n], q, a, c) || cross(q, ring[(i + 1) % n], a, c))
          return false;
      } else if (turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0) {
        return false;
      }
    }
    return true;
  }

  std::vector<Point> points_;
  collide::shapes::Dropped dropped_{};
  int sign_ = 1;  // of the normal along the dropped axis
  bool is_flat_ = true;
};

}  // namespace

void add_polygon(Surface& surface, std::span<const std::uint32_t> corners) {
  const auto add_fan = [&] {
    for (std::size_t i = 2; i < corners.size(); ++i)
      surface.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  };
  const auto is_usable = [&](std::uint32_t v) {
    return v < surface.vertices.size() && is_finite(surface.vertices[v]);
  };
  if (corners.size() <= 3 || !std::ranges::all_of(corners, is_usable)) return add_fan();
  const Polygon polygon(surface, corners);
  if (!polygon.is_flat()) ++surface.remarks["polygons that are not flat"];
  if (polygon.has_fan() && polygon.is_convex()) return add_fan();
  const bool is_simple = !polygon.crosses_itself();
  if (is_simple && polygon.has_fan()) return add_fan();
  const auto ears = is_simple ? polygon.ears() : std::vector<std::array<std::size_t, 3>>{};
  if (ears.empty()) {
    ++surface.remarks["polygons that cross themselves"];
    return add_fan();
  }
  for (const auto& [a, b, c] : ears)
    surface.triangles.push_back({corners[a], corners[b], corners[c]});
}

std::string remarks_text(const Surface& surface) {
  std::string out;
  for (const auto& [what, n] : surface.remarks)
    out += (out.empty() ? "" : ", ") + what + ": " + std::to_string(n);
  return out;
}

}  // namespace tess::dn
