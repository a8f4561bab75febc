#include "m2m/rigid_motion.hpp"

#include "runtime/core/error.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace tess::m2m {

namespace {

using Matrix = std::array<Point, 3>;

/// A number of quarter turns has no rounding of pi in it.
std::array<double, 2> sine_and_cosine(double angle) {
  constexpr double quarter = std::numbers::pi / 2;
  const double turns = std::nearbyint(angle / quarter);
  if (std::abs(angle - turns * quarter) > 0x1p-51 * std::abs(angle))
    return {std::sin(angle), std::cos(angle)};
  constexpr std::array<double, 4> sines{0, 1, 0, -1};
  const auto k = static_cast<std::size_t>(std::remainder(turns, 4) + 4);
  return {sines[k % 4], sines[(k + 1) % 4]};
}

/// Rodrigues' formula. The angle is not 0.
Matrix rotation(const RigidMotion& motion) {
  const auto& [a, b, c] = motion.axis;
  const double length = std::sqrt(a * a + b * b + c * c);
  if (!(length > 0 && std::isfinite(length)))
    fail(ErrorCode::bad_argument, "a rotation about the axis (", a, ", ", b, ", ", c,
         ") has no direction; give an axis of positive, finite length");
  const double x = a / length, y = b / length, z = c / length;
  const auto [s, k] = sine_and_cosine(motion.angle);
  const double r = 1 - k;
  return {{{k + r * x * x, r * x * y - s * z, r * x * z + s * y},
           {r * x * y + s * z, k + r * y * y, r * y * z - s * x},
           {r * x * z - s * y, r * y * z + s * x, k + r * z * z}}};
}

/// Calls turn(row, matrix) for each row of `width` values.
template <class Turn>
void turn_rows(std::span<double> values, std::size_t width, const char* what,
               const RigidMotion& motion, const Turn& turn) {
  if (values.size() % width != 0)
    fail(ErrorCode::bad_argument, values.size(), " values are no ", what, " of ", width,
         " components: give whole rows");
  if (motion.angle == 0) return;
  const Matrix matrix = rotation(motion);
  for (double* row = values.data(); row != values.data() + values.size(); row += width)
    turn(row, matrix);
}

/// T becomes R T Rᵀ.
Matrix turned(const Matrix& tensor, const Matrix& by) {
  Matrix half{}, out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) half[i][j] += by[i][k] * tensor[k][j];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) out[i][j] += half[i][k] * by[j][k];
  return out;
}

}  // namespace

void turn_vectors(std::span<double> values, const RigidMotion& motion) {
  turn_rows(values, 3, "vectors", motion, [](double* row, const Matrix& by) {
    const Point v{row[0], row[1], row[2]};
    for (std::size_t i = 0; i < 3; ++i)
      row[i] = by[i][0] * v[0] + by[i][1] * v[1] + by[i][2] * v[2];
  });
}

void turn_tensors(std::span<double> values, const RigidMotion& motion) {
  turn_rows(values, 9, "tensors", motion, [](double* row, const Matrix& by) {
    const Matrix out = turned(
        {{{row[0], row[1], row[2]}, {row[3], row[4], row[5]}, {row[6], row[7], row[8]}}}, by);
    for (std::size_t i = 0; i < 9; ++i) row[i] = out[i / 3][i % 3];
  });
}

void turn_symmetric_tensors(std::span<double> values, const RigidMotion& motion) {
  turn_rows(values, 6, "symmetric tensors", motion, [](double* t, const Matrix& by) {
    const Matrix out = turned({{{t[0], t[3], t[5]}, {t[3], t[1], t[4]}, {t[5], t[4], t[2]}}}, by);
    for (std::size_t i = 0; i < 3; ++i) t[i] = out[i][i];
    t[3] = out[0][1], t[4] = out[1][2], t[5] = out[0][2];
  });
}

void move_points(std::span<Point> points, const RigidMotion& motion) {
  Matrix matrix{};
  if (motion.angle != 0) matrix = rotation(motion);
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
