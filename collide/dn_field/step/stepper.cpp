#include "collide/dn_field/stepper.hpp"

#include "collide/dn_field/step/block_flight.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr int steps_at_once = 64;  // for which object poses are computed in advance

/// The number of steps since time 0, rounded where `time` is a multiple of the step up to rounding:
/// a run that is cut at `time` then has the same times to the bit.
double steps_before(double time, double step) {
  const double steps = time / step, whole = std::round(steps);
  return std::abs(steps - whole) < 1e-6 ? whole : steps;
}

}  // namespace

void Stepper::run(ParticleSpan particles, std::span<const Object> objects, double time,
                  int n_steps) const {
  run(particles, objects, time, n_steps, nullptr);
}

std::vector<Waypoint> Stepper::run_once(ParticleSpan particles, std::span<const Object> objects,
                                        double time) const {
  std::vector<Waypoint> waypoints;
  run(particles, objects, time, 1, &waypoints);
  return waypoints;
}

void Stepper::run(ParticleSpan particles, std::span<const Object> objects, double time, int n_steps,
                  std::vector<Waypoint>* waypoints) const {
  const Plan& plan = *plan_;
  const Run run = run_of(plan, objects);
  std::vector<Object> standing(objects.begin(), objects.end());
  if (!plan.samples_fields) standing.clear();
  const double before = steps_before(time, plan.step);
  const auto flight = std::make_unique<BlockFlight>(waypoints != nullptr);
  const std::size_t whole = particles.count / lanes::width * lanes::width;
  // The last particles, fewer than a vector, get a vector of their own.
  const ParticleSpan rest = particles.part(whole, particles.count - whole);
  const auto room = std::make_unique<ParticleRoom>();
  copy(rest, room->span(rest.count));
  for (int done = 0; done < n_steps; done += steps_at_once) {
    const int now = std::min(steps_at_once, n_steps - done);
    const ObjectPoses poses = object_poses(run, standing, before + done, now);
    const auto fly = [&](std::size_t first, const ParticleSpan& block) {
      flight->fly(run, poses, block);
      if (waypoints == nullptr) return;
      for (const Waypoint& bend : flight->waypoints())
        if (first + bend.particle < particles.count)
          waypoints->push_back({first + bend.particle, bend.part, bend.place});
    };
    for (std::size_t first = 0; first < whole; first += block_size)
      fly(first, particles.part(first, std::min(block_size, whole - first)));
    if (whole < particles.count) fly(whole, room->span(lanes::width));
  }
  copy(room->span(rest.count), rest);
}

void advance(std::span<Object> objects, double step, int n_steps) {
  for (Object& object : objects)
    if (object.frame.is_moving())
      for (int i = 0; i < n_steps; ++i) object.frame.advance(step);
}

void validate(const Rules& rules, std::span<const Object> objects) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Object& object = objects[i];
    const Frame& frame = object.frame;
    if (object.field == nullptr || object.field->grid.size() == 0 ||
        (object.field->planes == nullptr &&
         object.field->distance.size() != object.field->grid.size()))
      fail(ErrorCode::bad_argument, "object ", i, " has no field; build one");
    const Field& field = *object.field;
    const bool compressed = field.planes != nullptr;
    if (compressed != (objects[0].field->planes != nullptr))
      fail(ErrorCode::bad_argument, "of the fields of objects 0 and ", i,
           " one is compressed and one is flat; compress all of a scene or none");
    if (compressed && rules.look_up == LookUp::trilinear)
      fail(ErrorCode::bad_argument, "object ", i,
           " has a compressed field, which has no trilinear look-up; take nearest or tangent");
    if (rules.look_up == LookUp::trilinear && std::ranges::min(field.grid.n) < 2)
      fail(
          ErrorCode::bad_argument, "object ", i,
          " has a field of one voxel on an axis, between which the trilinear look-up cannot blend; "
          "take nearest or tangent");
    if (field.grid.size() >= std::size_t{1} << 31U)
      fail(ErrorCode::bad_argument, "object ", i, " has ", field.grid.size(),
           " voxels, above 2^31; lower its resolution");
    if (needed_content(rules) == Content::distance_and_normal &&
        (field.content() == Content::distance ||
         (!compressed && field.normal.size() != field.grid.size())))
      fail(ErrorCode::bad_argument, "object ", i,
           " stores no normals and a rule or the tangent look-up needs them; build its field with "
           "distance and normal");
    const double within =
        frame.scale * covered(field.thickness, field.grid.cell, field.sides, rules.look_up);
    if (reach(rules) > within)
      fail(ErrorCode::bad_argument, "a rule reaches ", reach(rules),
           " from where particles are stopped, and the field of object ", i, " only ", within,
           "; build a thicker field or shorten the rule's distance");
    for (const Vec3 v : {frame.position, frame.velocity, frame.angular_velocity,
                         Vec3{frame.scale, frame.scale_rate, 0}})
      if (!is_finite(v) || !(frame.scale > 0))
        fail(ErrorCode::bad_argument, "object ", i, " has (", v.x, ", ", v.y, ", ", v.z,
             ") as position, velocity, or scale and its rate, and the scale ", frame.scale,
             "; give finite numbers and a positive scale");
  }
}

}  // namespace tess::dn
