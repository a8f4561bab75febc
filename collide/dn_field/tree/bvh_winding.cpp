#include "collide/dn_field/bvh.hpp"

#include <numbers>

namespace tess::dn {
namespace {
constexpr double coarse = 2, fine = 12;       // the dipoles' error: a few per cent; a thousandth
constexpr double undecided_half_width = 0.2;  // |w - 1/2| below it: the fine sum decides

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
void add_half_angle(Turns& sum, Vec3 p, const PreparedTriangle& t) {
  const Vec3 a = t.corner[0] - p, b = t.corner[1] - p, c = t.corner[2] - p;
  const double la = norm(a), lb = norm(b), lc = norm(c), all = la * lb * lc;
  if (!(all > 0)) return;
  const double y = dot(a, cross(b, c)) / all;
  const double x = 1 + dot(a, b) / (la * lb) + dot(b, c) / (lb * lc) + dot(c, a) / (lc * la);
  sum.add(y, x);
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

bool Bvh::is_inside(Vec3 p) const {
  const double w = winding_number(p, coarse);
  return std::abs(w - 0.5) > undecided_half_width ? w > 0.5 : winding_number(p, fine) > 0.5;
}

}  // namespace tess::dn
