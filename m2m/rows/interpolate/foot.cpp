#include "m2m/rows/interpolate/foot.hpp"

#include "collide/distance.hpp"
#include "m2m/rows/interpolate/orientation.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <span>

namespace tess::m2m {
namespace {

/// A sum of products of differences, and the sum of their absolute values. Up to the fourth degree
/// the rounding error of the value is below 11 units, which the bound exceeds.
struct Sum {
  double value = 0, size = 0;
};
constexpr double error_bound = 16 * 0x1p-53;
/// Sums of other sizes may have lost digits in the range of double.
constexpr double least_size = 1e-280, most_size = 1e280;

bool is_in_range(double size) {
  return size > least_size && size < most_size;
}

/// The sum of absolute products. It is 0 only if each has a factor 0, and not by underflow.
double size_of(const Point& products, const Point& a, const Point& b) {
  const double size = products[0] + products[1] + products[2];
  for (std::size_t k = 0; k < 3 && size == 0; ++k)
    if (a[k] != 0 && b[k] != 0) return std::numeric_limits<double>::min();
  return size;
}

Sum dot_of(const Point& a, const Point& b) {
  const double x = a[0] * b[0], y = a[1] * b[1], z = a[2] * b[2];
  return {x + y + z, size_of({std::abs(x), std::abs(y), std::abs(z)}, a, b)};
}

/// A cross product, and bounds of the products in it.
struct Cross {
  Point value, size;
};
Cross cross_of(const Point& a, const Point& b) {
  Cross out;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
    const double left = a[u] * b[v], right = a[v] * b[u];
    out.value[k] = left - right;
    out.size[k] = std::abs(left) + std::abs(right);
  }
  return out;
}
Sum dot_of(const Cross& a, const Cross& b) {
  const Point products{a.size[0] * b.size[0], a.size[1] * b.size[1], a.size[2] * b.size[2]};
  return {dot(a.value, b.value), size_of(products, a.size, b.size)};
}

/// Whether a number is positive. It is not if all products are 0.
enum class Answer : std::uint8_t { no, yes, unsure };
Answer is_positive(const Sum& sum) {
  if (std::abs(sum.value) > error_bound * sum.size && is_in_range(sum.size))
    return sum.value > 0 ? Answer::yes : Answer::no;
  return sum.size == 0 ? Answer::no : Answer::unsure;
}

/// The differences of a triangle and a point, with what decides where the foot is.
struct TriangleSums {
  Cross normal;
  std::array<Sum, 3> from, to;  // along edge i from corner i, and from its other end
  std::array<Sum, 3> side;      // of edge i: positive within the triangle

  TriangleSums(const Point& p, const std::array<Point, 4>& c) {
    normal = cross_of(difference(c[1], c[0]), difference(c[2], c[0]));
    for (std::size_t i = 0; i < 3; ++i) {
      const Point &a = c[i], &b = c[(i + 1) % 3];
      const Point edge = difference(b, a), way = difference(p, a);
      from[i] = dot_of(edge, way);
      to[i] = dot_of(difference(a, b), difference(p, b));
      side[i] = dot_of(normal, cross_of(edge, way));
    }
  }
};

constexpr std::array<std::uint8_t, 3> edge_bits{0b011, 0b110, 0b101};

/// The feature of a triangle that holds the foot; 0 if rounding may decide.
std::uint8_t rounded_feature(const TriangleSums& sums) {
  std::array<Answer, 3> from, to, side;
  for (std::size_t i = 0; i < 3; ++i) {
    from[i] = is_positive(sums.from[i]);
    to[i] = is_positive(sums.to[i]);
    side[i] = is_positive(sums.side[i]);
  }
  if (side[0] == Answer::yes && side[1] == Answer::yes && side[2] == Answer::yes) return 0b111;
  for (std::size_t i = 0; i < 3; ++i) {
    if (from[i] == Answer::yes && to[i] == Answer::yes && side[i] == Answer::no)
      return edge_bits[i];
    if (from[i] == Answer::no && to[(i + 2) % 3] == Answer::no)
      return static_cast<std::uint8_t>(1U << i);
  }
  return 0;
}

template <std::size_t N>
std::uint8_t bits_of(const std::array<double, N>& weights) {
  std::uint8_t bits = 0;
  for (std::size_t i = 0; i < N; ++i)
    if (weights[i] > 0) bits = static_cast<std::uint8_t>(bits | (1U << i));
  return bits;
}

collide::Triangle triangle_of(const std::array<Point, 4>& c) {
  return {{c[0], c[1], c[2]}};
}

/// The lengths of vectors whose squares leave the range of double, too.
double length_of(const Point& r) {
  const double squared = dot(r, r);
  return is_in_range(squared) ? std::sqrt(squared) : std::hypot(r[0], r[1], r[2]);
}

/// The vector from `p` to its foot, kept within the box of the corners: rounding brings it no nearer
/// to `p` than the box is.
double length_within(Point r, const Point& p, std::span<const Point> corners) {
  for (std::size_t k = 0; k < 3; ++k) {
    double low = corners[0][k] - p[k], high = low;
    for (const Point& c : corners.subspan(1)) {
      low = std::min(low, c[k] - p[k]);
      high = std::max(high, c[k] - p[k]);
    }
    r[k] = std::min(std::max(r[k], low), high);
  }
  return length_of(r);
}

/// From a point whose foot is between the ends.
double distance_from_edge(const Point& p, const Point& a, const Point& b) {
  const std::array<Point, 2> ends = a < b ? std::array{a, b} : std::array{b, a};
  const Point edge = difference(ends[1], ends[0]), way = difference(p, ends[0]);
  const double squared = dot(edge, edge), t = dot(edge, way) / squared;
  Point r;
  for (std::size_t k = 0; k < 3; ++k) r[k] = t * edge[k] - way[k];
  const double distance = length_within(r, p, ends);
  // Near to the edge the digits are lost.
  if (is_in_range(squared) && distance * distance > 1e-12 * squared) return distance;
  return std::sqrt(collide::distance2(collide::Segment{ends[0], ends[1]}, p));
}

/// From a point whose foot is in the face.
double distance_from_face(const Point& p, const std::array<Point, 4>& c) {
  const Cross normal = cross_of(difference(c[1], c[0]), difference(c[2], c[0]));
  const Point way = difference(c[0], p);
  double height = dot(normal.value, way);
  if (!(std::abs(height) >
        error_bound * dot(normal.size, {std::abs(way[0]), std::abs(way[1]), std::abs(way[2])})))
    height = orientation_exact(p, c[0], c[1], c[2]);
  if (height == 0) return 0;
  const double squared = dot(normal.value, normal.value);
  if (!is_in_range(squared) || squared < 1e-12 * dot(normal.size, normal.size))
    return std::sqrt(collide::distance2(triangle_of(c), p));
  Point r;
  for (std::size_t k = 0; k < 3; ++k) r[k] = normal.value[k] * (height / squared);
  const double distance = length_within(r, p, std::span(c).first(3));
  return distance > 0 ? distance : std::sqrt(collide::distance2(triangle_of(c), p));
}

Foot foot_on_triangle(const Point& p, const std::array<Point, 4>& c) {
  std::uint8_t feature = rounded_feature(TriangleSums(p, c));
  if (feature == 0) feature = bits_of(collide::nearest_weights(triangle_of(c), p));
  for (std::size_t i = 0; i < 3; ++i) {
    if (feature == 1U << i) return {length_of(difference(c[i], p)), feature};
    if (feature == edge_bits[i]) return {distance_from_edge(p, c[i], c[(i + 1) % 3]), feature};
  }
  return {distance_from_face(p, c), feature};
}

Foot foot_on_edge(const Point& p, const Point& a, const Point& b) {
  const Answer after = is_positive(dot_of(difference(b, a), difference(p, a)));
  const Answer before = is_positive(dot_of(difference(a, b), difference(p, b)));
  std::uint8_t feature = 0;
  if (after == Answer::unsure || before == Answer::unsure)
    feature = bits_of(collide::nearest_weights(collide::Segment{a, b}, p));
  else
    feature = after == Answer::no ? 0b01 : before == Answer::no ? 0b10 : 0b11;
  if (feature == 0b11) return {distance_from_edge(p, a, b), feature};
  return {length_of(difference(feature == 0b01 ? a : b, p)), feature};
}

/// True if the sum, as a share of the whole, is within 1e-12.
bool is_exact_enough(const Sum& sum, double whole) {
  return error_bound * sum.size < 1e-12 * whole && is_in_range(whole);
}

std::array<double, 2> weights_on_edge(const Point& p, const Point& a, const Point& b) {
  const Point edge = difference(b, a);
  const double whole = dot(edge, edge);
  const Sum part = dot_of(edge, difference(p, a));
  const double t = part.value / whole;
  if (is_exact_enough(part, whole) && t > 0 && t < 1) return {1 - t, t};
  return collide::nearest_weights(collide::Segment{a, b}, p);
}

std::array<double, 3> weights_on_face(const Point& p, const std::array<Point, 4>& c) {
  const TriangleSums sums(p, c);
  const double whole = (sums.side[0].value + sums.side[1].value) + sums.side[2].value;
  std::array<double, 3> weights;
  bool is_exact = true;
  for (std::size_t i = 0; i < 3; ++i) {
    weights[(i + 2) % 3] = sums.side[i].value / whole;
    is_exact = is_exact && is_exact_enough(sums.side[i], whole) && sums.side[i].value > 0;
  }
  return is_exact ? weights : collide::nearest_weights(triangle_of(c), p);
}

}  // namespace

Foot foot_of(const Point& p, const std::array<Point, 4>& corners, std::int32_t dimension) {
  if (dimension == 1) return foot_on_edge(p, corners[0], corners[1]);
  if (dimension == 2) return foot_on_triangle(p, corners);
  Foot best{std::numeric_limits<double>::infinity(), 0};
  for (const auto& [i, j, k] : faces_of_tet) {
    const Foot foot = foot_on_triangle(p, {corners[i], corners[j], corners[k], corners[k]});
    if (!(foot.distance < best.distance)) continue;
    best = {foot.distance, 0};
    for (std::size_t n = 0; n < 3; ++n)
      if ((foot.feature >> n & 1U) != 0)
        best.feature = static_cast<std::uint8_t>(best.feature | (1U << std::array{i, j, k}[n]));
  }
  return best;
}

// Beyond an edge the distance is at least that from the edge's line within the plane. The margins are
// far above the rounding error of `side`, and its square is a normal number.
bool is_beyond(const Point& p, const std::array<Point, 4>& c, double squared_distance) {
  const Point normal = cross(difference(c[1], c[0]), difference(c[2], c[0]));
  const double area = dot(normal, normal);
  bool beyond = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point edge = difference(c[(i + 1) % 3], c[i]), way = difference(p, c[i]);
    const double side = dot(normal, cross(edge, way));
    const double least = 1.001 * squared_distance + 1e-20 * dot(way, way);
    beyond |= (side < 0) & (side * side > 1e-280) & (side * side > area * dot(edge, edge) * least);
  }
  return beyond;
}

Location location_of(const Foot& foot, const Point& p, const std::array<Point, 4>& corners,
                     std::int32_t dimension) {
  const int n_corners = std::popcount(foot.feature);
  Location location{{}, foot.distance, Status::snapped};
  if (foot.distance == 0)
    location.status = n_corners == dimension + 1 ? Status::inside : Status::boundary;
  if (foot.distance == 0 && n_corners == 1) location.place = Place::corner;
  std::array<std::size_t, 4> at{};
  std::array<Point, 4> of{};
  for (std::size_t k = 0, n = 0; k < 4; ++k)
    if ((foot.feature >> k & 1U) != 0) {
      at[n] = k;
      of[n++] = corners[k];
    }
  location.weights[at[0]] = 1;
  if (n_corners == 2) {
    const std::array<double, 2> weights = weights_on_edge(p, of[0], of[1]);
    for (std::size_t n = 0; n < 2; ++n) location.weights[at[n]] = weights[n];
  } else if (n_corners == 3) {
    const std::array<double, 3> weights = weights_on_face(p, of);
    for (std::size_t n = 0; n < 3; ++n) location.weights[at[n]] = weights[n];
  }
  return location;
}

int side_of(const Point& p, const std::array<Point, 4>& corners) {
  const double volume = orientation(p, corners[0], corners[1], corners[2]);
  return volume < 0 ? 1 : volume > 0 ? -1 : 0;
}

}  // namespace tess::m2m
