#include "apps/collide_scene/scenes/elementary.hpp"

#include <cmath>
#include <numbers>

namespace collide_scene {

double sine(double turns) noexcept {
  double t = turns - std::floor(turns + 0.5);  // exact, in [-1/2, 1/2)
  if (t > 0.25) t = 0.5 - t;
  if (t < -0.25) t = -0.5 - t;
  // The Taylor series of the sine, or beyond an eighth that of the cosine of the rest of a quarter.
  const bool small = std::abs(t) <= 0.125;
  const double x = 2 * std::numbers::pi * (small ? t : 0.25 - std::abs(t)), square = x * x;
  double sum = 1;
  for (int k = small ? 17 : 16; k >= 2; k -= 2) sum = 1 - square * sum / (k * (k - 1.0));
  return small ? x * sum : std::copysign(sum, t);
}

double cosine(double turns) noexcept {
  return sine(0.25 - (turns - std::floor(turns)));
}

double power_of_two(double x) noexcept {
  const double whole = std::floor(x + 0.5);
  const double y = (x - whole) * std::numbers::ln2;  // |y| <= 0.35
  double sum = 1;
  for (int k = 16; k >= 1; --k) sum = 1 + y * sum / k;
  return std::ldexp(sum, static_cast<int>(whole));
}

double cube_root(double x) noexcept {
  int exponent = 0;
  const double part = std::frexp(x, &exponent);  // in [1/2, 1)
  const int third = static_cast<int>(std::floor(exponent / 3.0));
  const double cube = std::ldexp(part, exponent - 3 * third);  // in [1/2, 4)
  double root = 1.2;
  for (int k = 0; k < 7; ++k) root -= (root - cube / (root * root)) / 3;  // Newton, quadratic
  return std::ldexp(root, third);
}

}  // namespace collide_scene
