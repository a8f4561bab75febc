// Checks that need several keys of a scene: each may be right by itself, and the run impossible.
#include "apps/particles/scene/json.hpp"
#include "apps/particles/scene/scene.hpp"
#include "collide/dn_field/walls.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace particles {
namespace {
using namespace tess::dn;

template <class... Text>
[[noreturn]] void refuse(const Scene& scene, std::size_t object, const Text&... text) {
  tess::fail(tess::ErrorCode::bad_value, scene.name, ": objects[", object, text...);
}

/// The field is as thick as the rules reach and, without sweep, as a particle flies in a step.
void check_thickness(const Scene& scene, std::size_t number, double scale) {
  const SceneObject& object = scene.objects[number];
  const Rules& rules = scene.rules;
  const double thickness = object.thickness * scale,
               covers =
                   scale * covered(object.thickness, object.grid.cell, object.sides, rules.look_up);
  if (reach(rules) > covers)
    refuse(scene, number, "].thickness: ", object.thickness, " times scale ", scale,
           covers < thickness
               ? fmt::format(", less {:g} that a sheet keeps off,", thickness - covers)
               : "",
           " is below the distance ", reach(rules), " at which a rule begins to act");
  if ((rules.impact && rules.impact->sweep == Sweep::on) || !needs_field(rules)) return;
  const Frame& frame = object.frame;
  // The object turns and grows about its origin, of which the surface may be far.
  double furthest = 0;
  each_corner(object.surface, [&](Vec3 p) { furthest = std::max(furthest, norm(p)); });
  const double surface = norm(frame.velocity) +
                         norm(frame.angular_velocity) * greatest_scale(scene, object) * furthest +
                         std::abs(frame.scale_rate) * furthest;
  for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
    const Emitter& emitter = scene.emitters[e];
    const double speed = norm(emitter.velocity) + std::sqrt(3.0) * emitter.spread +
                         std::abs(emitter.outward) + surface;
    if (speed * scene.dt > thickness)
      tess::fail(tess::ErrorCode::bad_value, scene.name, ": emitters[", e, "]: speed ", speed,
                 " times dt ", scene.dt, " passes the field of objects[", number, "], ", thickness,
                 " thick, in one step; use impact with sweep, a thicker field or a shorter step");
  }
}

/// Fields and look-ups compute in floats, and with squares: lengths and speeds are within range. A
/// cell is wide against the distance of neighbouring doubles where the object gets.
void check_units(const Scene& scene, std::size_t number, double scale) {
  constexpr double largest = 1e15, least = 1e-15;
  constexpr double positions_a_cell = 16, unit = 2.2e-16;  // of a double, relative
  const SceneObject& object = scene.objects[number];
  const Frame& frame = object.frame;
  const auto check = [&](double value, const char* what) {
    if (!(value >= least && value <= largest))
      refuse(scene, number, "]: ", what, " is ", value, ", not within ", least, " … ", largest,
             ", which fields support; choose other units");
  };
  check(object.grid.cell, "a cell of its field");
  check(object.grid.cell * scale, "a cell in the world, at its smallest");
  check(object.thickness * greatest_scale(scene, object), "its thickness in the world");
  check(object.grid.cell * frame.scale / scene.dt, "a cell a step, as a speed,");
  const Bounds box = bounds(object.surface);
  const double cell = object.grid.cell * scale,
               reaches = norm(frame.position) + norm(frame.velocity) * scene.dt * scene.steps +
                         greatest_scale(scene, object) *
                             (std::max(norm(box.low), norm(box.high)) + object.thickness);
  if (!(cell >= positions_a_cell * unit * reaches))
    refuse(scene, number, "]: a cell of its field is ", cell, " wide in the world, and positions ",
           reaches, " from the origin, where it gets, are ", unit * reaches,
           " apart; move the scene to the origin, or choose a coarser field");
}

/// A spring pushes along the normal at the start of a step, and an impact bounces on the way: if the
/// body turns far meanwhile, the one pushes particles through what the other would stop.
void check_turn(const Scene& scene, std::size_t number) {
  // Radian in a step. Of 300 particles about a wedge 22 tunnel at 1, 21 at 0.15, 3 at 0.1, none at
  // 0.05.
  constexpr double most_turn = 0.05;
  const double turn = norm(scene.objects[number].frame.angular_velocity) * scene.dt;
  if (scene.rules.spring && scene.rules.impact && turn > most_turn)
    refuse(scene, number, "].motion.spin: turns ", turn, " rad in a step of dt ", scene.dt,
           ", more than ", most_turn, " with spring and impact together; give a dt of ",
           // A little less, since six digits are printed.
           0.9999 * scene.dt * most_turn / turn, " or less");
}

void check_object(const Scene& scene, std::size_t number) {
  const SceneObject& object = scene.objects[number];
  const double scale = least_scale(scene, object);
  if (!(scale > 0))
    refuse(scene, number, "].motion.scale: ", object.frame.scale_rate,
           " a second takes the scale from ", object.frame.scale, " to ", scale, " in ",
           scene.steps, " steps of ", scene.dt, "; it must stay above 0");
  check_thickness(scene, number, scale);
  check_turn(scene, number);
  if (builds_fields(scene)) check_units(scene, number, scale);
  if (object.thin_share > most_thin)
    refuse(scene, number, "].shape: ", 100 * object.thin_share,
           " % of its surface is an open sheet, or a wall thinner than ",
           least_wall(scene.rules, object), ", which a field of ", object.grid.n[0],
           " voxels needs; particles would pass it: take sides two, or a higher resolution");
}

}  // namespace

void require_normals(const SceneObject& object) {
  if (!object.field_has_normals)
    tess::fail(tess::ErrorCode::bad_file, object.field,
               ": stores no normals, which are needed here; build it with distance and normal");
}

void check_scene(const Scene& scene) {
  for (const double mass : masses_of(scene)) {
    try {
      validate(for_mass(scene.rules, mass));
    } catch (const tess::Error& error) {
      tess::fail(tess::ErrorCode::bad_value, scene.name, ": rules.", error.what(), " (mass ", mass,
                 ")");
    }
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) check_object(scene, i);
}

}  // namespace particles
