// Checks that need several keys of a scene: each may be right by itself, and the run impossible.
#include "apps/particles/scene/json.hpp"
#include "apps/particles/scene/scene.hpp"
#include "collide/dn_field/walls.hpp"
#include "runtime/core/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace particles {
namespace {
using namespace tess::dn;

/// The checks of one object in its scene.
class ObjectCheck {
 public:
  ObjectCheck(const Scene& scene, std::size_t number)
      : scene_(scene), object_(scene.objects[number]), number_(number) {
    const Frame& frame = object_.frame;
    const Bounds box = bounds(object_.surface);
    const double radius = std::max(norm(box.low), norm(box.high)) + object_.thickness;
    least_ = least_scale(scene, object_), greatest_ = greatest_scale(scene, object_);
    reach_ =
        norm(frame.position) + norm(frame.velocity) * scene.dt * scene.steps + greatest_ * radius;
  }

  /// All positions are numbers that doubles can square; the scale stays positive.
  void check_magnitude() const {
    if (!(reach_ <= largest_number))
      refuse("]: by its shape, transform and motion it reaches ", reach_, " from the origin in ",
             scene_.steps, " steps of ", scene_.dt, ", beyond ", largest_number,
             ", the largest number supported; choose other units, or a slower motion");
    if (!(least_ > 0))
      refuse("].motion.scale: ", object_.frame.scale_rate, " a second takes the scale from ",
             object_.frame.scale, " to ", least_, " in ", scene_.steps, " steps of ", scene_.dt,
             "; it must stay above 0");
  }

  /// The field is as thick as the rules reach and, without sweep, as a particle flies in a step.
  void check_thickness() const {
    const bool sweeps = scene_.rules.impact && scene_.rules.impact->sweep == Sweep::on;
    const double reach = tess::dn::reach(scene_.rules), thickness = object_.thickness * least_;
    const double covers =
        least_ * covered(object_.thickness, object_.grid.cell, object_.sides, scene_.rules.look_up);
    if (reach > covers)
      refuse("].thickness: ", object_.thickness, " times scale ", least_,
             covers < thickness
                 ? fmt::format(", less {:g} that a sheet keeps off,", thickness - covers)
                 : "",
             " is below the distance ", reach, " at which a rule begins to act");
    if (sweeps || !needs_field(scene_.rules)) return;
    const Frame& frame = object_.frame;
    const double extent = norm(bounds(object_.surface).size());
    const double surface = norm(frame.velocity) +
                           norm(frame.angular_velocity) * frame.scale * extent +
                           std::abs(frame.scale_rate) * extent;
    for (std::size_t e = 0; e < scene_.emitters.size(); ++e) {
      const Emitter& emitter = scene_.emitters[e];
      const double speed = norm(emitter.velocity) + std::sqrt(3.0) * emitter.spread +
                           std::abs(emitter.outward) + surface;
      if (speed * scene_.dt > thickness)
        tess::fail(tess::ErrorCode::bad_value, scene_.name, ": emitters[", e, "]: speed ", speed,
                   " times dt ", scene_.dt, " passes the field of objects[", number_, "], ",
                   thickness,
                   " thick, in one step; use impact with sweep, a thicker field or a shorter step");
    }
  }

  /// Fields and look-ups compute in floats, and with squares: lengths and speeds are within range.
  void check_units() const {
    constexpr double largest = 1e15, least = 1e-15;
    const auto check = [&](double value, const char* what) {
      if (value >= least && value <= largest) return;
      refuse("]: ", what, " is ", value, ", not within ", least, " … ", largest,
             ", which fields support; choose other units");
    };
    check(object_.grid.cell, "a cell of its field");
    check(object_.thickness, "its thickness");
    check(object_.grid.cell * least_, "a cell in the world, at its smallest");
    check(object_.thickness * greatest_, "its thickness in the world");
    check(object_.grid.cell * object_.frame.scale / scene_.dt, "a cell a step, as a speed,");
  }

  /// A cell is wide against the distance of neighbouring doubles where the object is.
  void check_offset() const {
    constexpr double positions_a_cell = 16, unit = 2.2e-16;  // of a double, relative
    const double cell = object_.grid.cell * least_;
    if (!(cell >= positions_a_cell * unit * reach_))
      refuse("]: a cell of its field is ", cell, " wide in the world, and positions ", reach_,
             " from the origin, where it gets, are ", unit * reach_,
             " apart; move the scene to the origin, or choose a coarser field");
  }

  /// No large part of the surface is a wall that fits between voxels: particles would pass it.
  void check_walls() const {
    if (object_.thin_share <= most_thin) return;
    refuse("].shape: ", 100 * object_.thin_share,
           " % of its surface is an open sheet, or a wall thinner than ",
           least_wall(scene_.rules, object_), ", which a field of ", object_.grid.n[0],
           " voxels needs; particles would pass it: take sides two, or a higher resolution");
  }

 private:
  template <class... Text>
  [[noreturn]] void refuse(const Text&... text) const {
    tess::fail(tess::ErrorCode::bad_value, scene_.name, ": objects[", number_, text...);
  }

  const Scene& scene_;
  const SceneObject& object_;
  std::size_t number_;
  double least_, greatest_;  // scales in the run
  double reach_;             // the largest distance from the origin in the run, at most
};

}  // namespace

void check_scene(const Scene& scene) {
  for (const double mass : masses_of(scene)) {
    try {
      validate(for_mass(scene.rules, mass));
    } catch (const tess::Error& error) {
      tess::fail(tess::ErrorCode::bad_value, scene.name, ": rules.", error.what(), " (mass ", mass,
                 ")");
    }
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const ObjectCheck check(scene, i);
    check.check_magnitude();
    check.check_thickness();
    if (builds_fields(scene)) check.check_units();
    if (needs_field(scene.rules)) check.check_offset();
    check.check_walls();
  }
}

}  // namespace particles
