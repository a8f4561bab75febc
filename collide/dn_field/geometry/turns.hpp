// A sum of angles with one arc tangent in all: an angle is the argument of a complex number, the
// sum that of their product, and whole turns are counted where the product crosses the negative
// real axis.
#pragma once

#include <cmath>
#include <numbers>

namespace tess::dn {

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

}  // namespace tess::dn
