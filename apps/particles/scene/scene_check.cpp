// What the keys of a scene say together: each may be right by itself, and the run still impossible.
#include "apps/particles/scene/json.hpp"
#include "apps/particles/scene/scene.hpp"
#include "runtime/core/error.hpp"

#include <cmath>

namespace particles {
namespace {

/// How far from the origin the object reaches in the whole run, at most.
double furthest(const Scene& scene, const SceneObject& object) {
  const tess::dn::Frame& frame = object.frame;
  const double time = scene.dt * scene.steps;
  const tess::dn::Bounds box = bounds(object.surface);
  const double radius = std::max(norm(box.low), norm(box.high)) + object.thickness;
  return norm(frame.position) + norm(frame.velocity) * time +
         greatest_scale(scene, object) * radius;
}

/// Fields and look-ups reckon in floats, and with squares: what they are given must be within
/// their reach, the way of a step too.
void check_units(const Scene& scene, const std::string& file) {
  constexpr double largest = 1e15, least = 1e-15;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const auto check = [&](double value, const char* what) {
      if (value >= least && value <= largest) return;
      tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i, "]: ", what, " is ", value,
                 ", not within ", least, " … ", largest,
                 ", in which fields can be reckoned; choose other units");
    };
    check(object.grid.cell, "a cell of its field");
    check(object.thickness, "its thickness");
    check(object.grid.cell * least_scale(scene, object), "a cell in the world, at its smallest");
    check(object.thickness * greatest_scale(scene, object), "its thickness in the world");
    check(object.grid.cell * object.frame.scale / scene.dt, "a cell a step, as a speed,");
  }
}

/// A cell must be wide against what tells positions apart where the object is: particles there
/// stand on a lattice of doubles.
void check_offset(const Scene& scene, const std::string& file) {
  constexpr double positions_a_cell = 16, unit = 2.2e-16;  // of a double, relative
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const double cell = object.grid.cell * least_scale(scene, object),
                 reach = furthest(scene, object);
    if (cell >= positions_a_cell * unit * reach) continue;
    tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i, "]: a cell of its field is ",
               cell, " wide in the world, and positions ", reach,
               " from the origin, where it gets, are ", unit * reach,
               " apart; move the scene to the origin, or choose a coarser field");
  }
}

void check_magnitude(const Scene& scene, const std::string& file) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const double reach = furthest(scene, scene.objects[i]);
    if (reach <= largest_number) continue;
    tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i,
               "]: by its shape, transform and motion it reaches ", reach, " from the origin in ",
               scene.steps, " steps of ", scene.dt, ", beyond ", largest_number,
               ", the largest that can be reckoned with; choose other units, or a slower motion");
  }
}

/// A field knows no wall that fits between its voxels: particles would pass and nobody see it.
void check_walls(const Scene& scene, const std::string& file) {
  constexpr double most_thin = 0.1, most_slanted = 0.5;  // of the surface; the latter with edges
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const double needed = least_wall(scene, object), thin = thin_share(scene, object);
    const bool by_walls = object.walls.share_thinner(needed) > most_thin;
    if (thin == 0 || (!by_walls && thin <= most_slanted)) continue;
    // All but as many as are let through are thicker than this one.
    const auto& list = by_walls ? object.walls.opposite : object.walls.slanted;
    const double let_through = (by_walls ? most_thin : most_slanted) * object.walls.n_places();
    const double wall =
        list[static_cast<std::size_t>(std::min(let_through, static_cast<double>(list.size() - 1)))];
    const double shrink = (wall + kept_off(scene, object)) / (needed + kept_off(scene, object));
    const double resolution = std::ceil((object.grid.n[0] - 1) / shrink) + 1;
    tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i, "].shape: ", 100 * thin,
               " % of its surface is an open sheet, or a wall thinner than ", needed,
               ", which a field of ", object.grid.n[0],
               " voxels needs; particles would pass it: take ",
               object.field.empty() ? "" : "a field of ", "sides two",
               object.method == tess::dn::Method::normals ? " and another method" : "",
               shrink > 0 && resolution <= 1024
                   ? tess::text(", or a resolution of ", resolution, " or more")
                   : "");
  }
}

/// What no key by itself can say: the rules fit the masses, the fields cover the rules.
void check_rules(const Scene& scene, const std::string& file) {
  for (const double mass : masses_of(scene)) {
    try {
      validate(for_mass(scene.rules, mass));
    } catch (const tess::Error& error) {
      tess::fail(tess::ErrorCode::bad_value, file, ": rules.", error.what(), " (mass ", mass, ")");
    }
  }
  const bool sweeps = scene.rules.impact && scene.rules.impact->sweep == tess::dn::Sweep::on;
  const double reach = tess::dn::reach(scene.rules);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const tess::dn::Frame& frame = object.frame;
    const double least = least_scale(scene, object);
    if (!(least > 0))
      tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i,
                 "].motion.scale: ", frame.scale_rate, " a second takes the scale from ",
                 frame.scale, " to ", least, " in ", scene.steps, " steps of ", scene.dt,
                 "; it must stay above 0");
    const double covered = object.thickness * least,
                 within = least * tess::dn::covered(object.thickness, object.grid.cell,
                                                    object.sides, look_up_of(scene.rules));
    if (reach > within)
      tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i,
                 "].thickness: ", object.thickness, " times scale ", least,
                 within < covered
                     ? tess::text(", less ", covered - within, " that a sheet keeps off,")
                     : "",
                 " is below the distance ", reach, " at which a rule begins to act");
    if (sweeps || !needs_field(scene.rules)) continue;
    const double extent = norm(bounds(object.surface).size());
    const double surface = norm(frame.velocity) +
                           norm(frame.angular_velocity) * frame.scale * extent +
                           std::abs(frame.scale_rate) * extent;
    for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
      const Emitter& emitter = scene.emitters[e];
      const double speed = norm(emitter.velocity) + std::sqrt(3.0) * emitter.spread +
                           std::abs(emitter.outward) + surface;
      if (speed * scene.dt > covered)
        tess::fail(tess::ErrorCode::bad_value, file, ": emitters[", e, "]: speed ", speed,
                   " times dt ", scene.dt, " passes the field of objects[", i, "], ", covered,
                   " thick, in one step; use impact with sweep, a thicker field or a shorter step");
    }
  }
}

}  // namespace

void check_scene(const Scene& scene) {
  check_magnitude(scene, scene.name);
  check_rules(scene, scene.name);
  if (builds_fields(scene)) check_units(scene, scene.name);
  if (needs_field(scene.rules)) check_offset(scene, scene.name);
  check_walls(scene, scene.name);
}

}  // namespace particles
