// The parts of stepper.hpp around the loop: what is asked of objects, and what is summed over
// particles.
#include "collide/dn_field/stepper.hpp"
#include "runtime/core/error.hpp"

namespace tess::dn {

void advance(std::span<Object> objects, double step, int n_steps) {
  for (Object& object : objects)
    if (object.frame.is_moving())
      for (int i = 0; i < n_steps; ++i) object.frame.advance(step);
}

void validate(const Rules& rules, std::span<const Object> objects) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Object& object = objects[i];
    const Frame& frame = object.frame;
    const CompressedField* compressed = object.compressed;
    if ((compressed == nullptr) != (objects[0].compressed == nullptr))
      fail(ErrorCode::bad_argument, "object ", i,
           compressed == nullptr ? " has a flat field and object 0 a compressed one"
                                 : " has a compressed field and object 0 a flat one",
           "; compress all of a scene or none");
    if (compressed != nullptr && rules.look_up == LookUp::trilinear)
      fail(ErrorCode::bad_argument, "object ", i,
           " has a compressed field, which the trilinear look-up cannot ask; take nearest or "
           "tangent");
    if (object.field == nullptr || object.field->grid.size() == 0 ||
        (compressed == nullptr && object.field->distance.size() != object.field->grid.size()) ||
        (compressed != nullptr && compressed->grid.n != object.field->grid.n))
      fail(ErrorCode::bad_argument, "object ", i, " has no field; build one");
    if (object.field->grid.size() >= std::size_t{1} << 31U)
      fail(ErrorCode::bad_argument, "object ", i, " has ", object.field->grid.size(),
           " voxels, above 2^31; lower its resolution");
    if (needed_content(rules) == Content::distance_and_normal &&
        (compressed != nullptr ? compressed->content != Content::distance_and_normal
                               : object.field->normal.size() != object.field->grid.size()))
      fail(ErrorCode::bad_argument, "object ", i,
           " stores no normals and a rule or the tangent look-up needs them; build its field with "
           "distance and normal");
    const Field& field = *object.field;
    const double within =
        frame.scale * covered(field.thickness, field.grid.cell, field.sides, look_up_of(rules));
    if (reach(rules) > within)
      fail(ErrorCode::bad_argument, "a rule reaches ", reach(rules),
           " from where particles are stopped, and the field of object ", i, " only ", within,
           "; build a thicker field or shorten the rule's distance");
    if (!(frame.scale > 0) || !std::isfinite(frame.scale) || !std::isfinite(frame.scale_rate))
      fail(ErrorCode::bad_argument, "object ", i, " is scaled by ", frame.scale,
           ", which grows by ", frame.scale_rate,
           " a second; give a positive, finite scale and a finite rate");
    for (const Vec3 v : {frame.position, frame.velocity, frame.angular_velocity})
      if (!is_finite(v))
        fail(ErrorCode::bad_argument, "object ", i, " has (", v.x, ", ", v.y, ", ", v.z,
             ") as position or velocity; give finite numbers");
  }
}

double kinetic_energy(ParticleSpan particles) {
  double twice = 0;
  for (std::size_t p = 0; p < particles.count; ++p) {
    const Vec3 v{particles.vx[p], particles.vy[p], particles.vz[p]};
    if (const double square = dot(v, v); std::isfinite(square)) twice += square;
  }
  return 0.5 * twice;
}

std::size_t count_nonfinite(ParticleSpan particles) {
  std::size_t found = 0;
  for (std::size_t p = 0; p < particles.count; ++p)
    found += !is_finite({particles.x[p], particles.y[p], particles.z[p]}) ||
             !is_finite({particles.vx[p], particles.vy[p], particles.vz[p]});
  return found;
}

}  // namespace tess::dn
