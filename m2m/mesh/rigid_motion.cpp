#include "m2m/rigid_motion.hpp"

#include "runtime/core/error.hpp"

#include <array>
#include <cmath>

namespace tess::m2m {

// Rodrigues' formula as a matrix.
void move_points(std::span<Point> points, const RigidMotion& motion) {
  std::array<Point, 3> matrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (motion.angle != 0) {
    const auto& [a, b, c] = motion.axis;
    const double length = std::sqrt(a * a + b * b + c * c);
    if (!(length > 0 && std::isfinite(length)))
      fail(ErrorCode::bad_argument, "a rotation about the axis (", a, ", ", b, ", ", c,
           ") has no direction; give an axis of positive, finite length");
    const double x = a / length, y = b / length, z = c / length;
    const double s = std::sin(motion.angle), k = std::cos(motion.angle), r = 1 - k;
    matrix = {{{k + r * x * x, r * x * y - s * z, r * x * z + s * y},
               {r * x * y + s * z, k + r * y * y, r * y * z - s * x},
               {r * x * z - s * y, r * y * z + s * x, k + r * z * z}}};
  }
  for (Point& p : points) {
    Point moved{};
    for (std::size_t i = 0; i < 3; ++i) {
      double turned = p[i];
      if (motion.angle != 0) {
        turned = motion.centre[i];
        for (std::size_t j = 0; j < 3; ++j) turned += matrix[i][j] * (p[j] - motion.centre[j]);
      }
      moved[i] = turned + motion.translation[i];
    }
    p = moved;
  }
}

}  // namespace tess::m2m
