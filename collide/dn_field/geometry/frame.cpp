#include "collide/dn_field/frame.hpp"

#include "runtime/core/error.hpp"

namespace tess::dn {
namespace {

Vec3 turned(Vec3 v, Vec3 axis, double cosine, double sine) {  // Rodrigues
  return cosine * v + sine * cross(axis, v) + (1 - cosine) * dot(axis, v) * axis;
}

}  // namespace

std::array<Vec3, 3> rotation(Vec3 v) {
  const double angle = norm(v), cosine = std::cos(angle), sine = std::sin(angle);
  const Vec3 axis = direction(v);
  if (axis == Vec3{}) return Frame{}.axes;
  return {turned({1, 0, 0}, axis, cosine, sine), turned({0, 1, 0}, axis, cosine, sine),
          turned({0, 0, 1}, axis, cosine, sine)};
}

void Frame::advance(double step) {
  position += step * velocity;
  scale += step * scale_rate;
  if (angular_velocity == Vec3{}) return;
  const double angle = norm(angular_velocity) * step, cosine = std::cos(angle),
               sine = std::sin(angle);
  const Vec3 about = direction(angular_velocity);
  axes[0] = direction(turned(axes[0], about, cosine, sine));
  const Vec3 second = turned(axes[1], about, cosine, sine);
  axes[1] = direction(second - dot(second, axes[0]) * axes[0]);
  axes[2] = cross(axes[0], axes[1]);
}

Frame frame_from(const std::array<Vec3, 3>& columns, Vec3 translation) {
  constexpr double tolerance = 1e-6;  // files hold six or more digits
  for (const Vec3 c : {columns[0], columns[1], columns[2], translation})
    if (!is_finite(c))
      fail(ErrorCode::bad_value, "transform holds (", c.x, ", ", c.y, ", ", c.z,
           "); all entries must be finite");
  const double scale = norm(columns[0]);
  if (!(scale > 0) || !(norm(columns[1]) > 0) || !(norm(columns[2]) > 0))
    fail(ErrorCode::bad_value, "transform has zero scale; give a positive one");
  Frame frame;
  frame.scale = scale;
  frame.position = translation;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 c = columns[i], next = columns[(i + 1) % 3];
    if (std::abs(norm(c) - scale) > tolerance * scale)
      fail(ErrorCode::bad_value, "transform scales axis ", i, " by ", norm(c), " and axis 0 by ",
           scale, "; only uniform scale is possible");
    if (std::abs(dot(c, next)) > tolerance * scale * scale)
      fail(ErrorCode::bad_value, "transform has shear between axes ", i, " and ", (i + 1) % 3,
           "; apply it to the mesh instead");
    frame.axes[i] = (1 / norm(c)) * c;
  }
  if (dot(cross(frame.axes[0], frame.axes[1]), frame.axes[2]) < 0)
    fail(ErrorCode::bad_value, "transform mirrors the object; mirror the mesh instead");
  return frame;
}

}  // namespace tess::dn
