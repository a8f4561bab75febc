#include "collide/dn_field/bvh.hpp"

#include <numbers>

namespace tess::dn {
namespace {
constexpr double opening_ratio = 2.0;         // the dipole's error is a few per cent
constexpr double undecided_half_width = 0.2;  // |w - 1/2| below it: exact instead
constexpr double truncated = 0.5;  // of the first-order bound: error by the cluster's extent
constexpr double touching = 1e-9;  // of the corners' distances: nearer, rounding decides

/// A sum of angles with one arc tangent in all: an angle is the argument of a complex number, the
/// sum that of their product, and whole turns are counted where the product crosses the negative
/// real axis.
class Turns {
 public:
  /// Adds atan2(y, x), in (−π, π].
  void add(double y, double x) {
    const double re = re_ * x - im_ * y, im = re_ * y + im_ * x;
    const bool up = is_up(im_, re_), other_up = is_up(y, x);
    if (up && other_up && !is_up(im, re)) turns_ += 1;
    if (im_ < 0 && y < 0 && !(im < 0)) turns_ -= 1;
    re_ = re;
    im_ = im;
    const double size = std::fabs(re) + std::fabs(im);
    if (size < 1e-60 || size > 1e60) rescale(size);
  }
  [[nodiscard]] double angle() const {
    return 2 * std::numbers::pi * turns_ + std::atan2(im_, re_);
  }

 private:
  /// Whether the argument is in (0, π].
  static bool is_up(double im, double re) { return im > 0 || (im == 0 && re < 0); }
  void rescale(double size) {
    re_ = size > 0 ? re_ / size : 1;
    im_ = size > 0 ? im_ / size : 0;
  }

  double re_ = 1, im_ = 0, turns_ = 0;
};

/// Adds half the solid angle of `t` seen from `p` to `sum` (van Oosterom and Strackee 1983).
/// Returns false if rounding decides on which side of it `p` lies.
bool add_half_angle(Turns& sum, Vec3 p, const PreparedTriangle& t) {
  const Vec3 a = t.corner[0] - p, b = t.corner[1] - p, c = t.corner[2] - p;
  const double la = norm(a), lb = norm(b), lc = norm(c), all = la * lb * lc;
  if (!(all > 0)) return false;
  const double y = dot(a, cross(b, c)) / all;
  const double x = 1 + dot(a, b) / (la * lb) + dot(b, c) / (lb * lc) + dot(c, a) / (lc * la);
  sum.add(y, x);
  return x > touching || std::abs(y) > touching;
}

}  // namespace

double Bvh::winding_number(Vec3 p, double accuracy) const {
  double angle = 0;
  Turns halves;
  tree_.descend([&](std::uint32_t at) {
    const Moment& moment = moments_[at];
    const Vec3 to = moment.centre - p;
    const double distance2 = dot(to, to), reach = accuracy * moment.radius;
    if (accuracy > 0 && distance2 > reach * reach) {
      angle += dot(to, moment.area_normal) / (distance2 * std::sqrt(distance2));
      return false;
    }
    Tree::each_place(tree_.nodes()[at],
                     [&](std::uint32_t i) { add_half_angle(halves, p, prepared_[i]); });
    return true;
  });
  return (angle + 2 * halves.angle()) / (4 * std::numbers::pi);
}

// The solid angle of a cluster of area A at distance D changes by at most A s 2 / D³ over a
// distance s. The error by the cluster's extent r is of second order for a dipole at the centre of
// area; half of the bound for s = r covers it. Errors of many clusters have many signs and add up
// as independent ones; twice their root sum of squares is allowed for.
WindingEstimate Bvh::winding_estimate(Vec3 p, double radius, double accuracy) const {
  double angle = 0, error2 = 0;
  bool decided = true;
  Turns halves;
  const auto off_by = [&error2](double area, double shift, double distance) {
    const double off = 2 * area * shift / (distance * distance * distance);
    error2 += off * off;
  };
  tree_.descend([&](std::uint32_t at) {
    const Moment& moment = moments_[at];
    const Vec3 to = moment.centre - p;
    const double distance = norm(to);
    if (!decided) return false;
    if (distance > accuracy * moment.radius + 2 * radius) {
      angle += dot(to, moment.area_normal) / (distance * distance * distance);
      off_by(moment.area, radius + truncated * moment.radius, distance - radius);
      return false;
    }
    Tree::each_place(tree_.nodes()[at], [&](std::uint32_t i) {
      const PreparedTriangle& t = prepared_[i];
      if (radius > 0) {
        const double least = std::sqrt(distance2(t, p.x, p.y, p.z)) - radius;
        decided = decided && least > 0;
        off_by(0.5 * norm(cross(t.edge[0], t.edge[2])), radius, least);
      }
      decided = add_half_angle(halves, p, t) && decided;
    });
    return true;
  });
  if (!decided) return {0, HUGE_VAL};
  return {(angle + 2 * halves.angle()) / (4 * std::numbers::pi),
          2 * std::sqrt(error2) / (4 * std::numbers::pi) + 1e-9};
}

bool Bvh::is_inside(Vec3 p) const {
  const double w = winding_number(p, opening_ratio);
  return std::abs(w - 0.5) > undecided_half_width ? w > 0.5 : winding_number(p, 0) > 0.5;
}

}  // namespace tess::dn
