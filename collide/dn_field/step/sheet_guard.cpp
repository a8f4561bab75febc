#include "collide/dn_field/step/sheet_guard.hpp"

#include "collide/dn_field/step/leg.hpp"
#include "collide/dn_field/tree/bvh.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <ranges>

namespace tess::dn {
namespace {

constexpr double apart = 1e-6;      // of a cell: nearer to a sheet nobody is left
constexpr double hardly_any = 0.1;  // of the way at the speed of the start

/// No surface is nearer than this to `p`, as the voxel around it knows; negative outside the grid.
/// In the object's own coordinates, as all here.
double free_around(const Object& object, Vec3 p) {
  const Grid& grid = object.field->grid;
  std::array<int, 3> voxel{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double at = (component(p, axis) - component(grid.origin, axis)) / grid.cell + 0.5;
    if (!(at >= 0 && at < grid.n[a])) return -1;
    voxel[a] = static_cast<int>(at);
  }
  const auto [i, j, k] = voxel;
  const double known = object.compressed != nullptr
                           ? static_cast<double>(voxel_distance(*object.compressed, i, j, k)) -
                                 object.compressed->measured.distance
                           : static_cast<double>(object.field->distance[grid.index(i, j, k)]);
  return known - norm(p - grid.centre(i, j, k));
}

/// Where a particle stands and how fast it is.
struct Moving {
  Vec3 position, velocity;
};
/// When a step ends; the legs of its way before this one stay.
struct Kept {
  Moving at_end;
  std::size_t leg;
};

class Guard {
 public:
  explicit Guard(const SheetScene& scene)
      : constants_(scene.constants),
        sheets_(scene.sheets),
        slides_(!scene.springs),
        knows_all_(!scene.springs && scene.sheets_alone) {}

  /// Where a particle is to be that meets a sheet; none where it does not. `legs`: its way, in the
  /// order of time.
  std::optional<Kept> kept_off(std::span<const Leg> legs, Vec3 velocity, Vec3 end_velocity) {
    const Moving start{legs[0].from, velocity};
    for (std::size_t i = 0; i < legs.size(); ++i)
      if (const auto met = first_met(legs[i]))
        return knows_all_ ? Kept{flown(start), 0}
                          : Kept{along(legs[i], *met, start, end_velocity), i};
    return std::nullopt;
  }

 private:
  struct Met {
    const Object* sheet;
    double at;    // of the piece of the way that crosses: of the leg, if nothing moves
    Vec3 normal;  // of the triangle, against the way; in the world, when the step ends
  };

  std::optional<Met> first_met(const Leg& leg) {
    std::optional<Met> first;
    for (const Object& sheet : sheets_) {
      const auto met = crossed(sheet, leg);
      if (met && (!first || met->at < first->at)) first = met;
    }
    return first;
  }

  /// The first triangle on the way.
  std::optional<Met> crossed(const Object& sheet, const Leg& leg) {
    const double margin = apart * sheet.field->grid.cell;
    std::optional<Met> found;
    any_piece(sheet.frame, constants_.step, leg, [&](Vec3 from, Vec3 to) {
      const Vec3 way = to - from;
      const double length = norm(way);
      if (!(length > 0) || free_around(sheet, from) > length + margin) return false;
      crossings_.clear();
      sheet.triangles->crossings(from, to + (margin / length) * way, crossings_);
      if (crossings_.empty()) return false;
      const Crossing first = *std::ranges::min_element(crossings_, {}, &Crossing::at);
      const Vec3 side = sheet.triangles->normal(first.triangle);
      const Vec3 normal = frame_at(sheet.frame, constants_.step, 1).rotate(side);
      found = Met{&sheet, first.at, dot(side, way) > 0 ? -normal : normal};
      return true;
    });
    return found;
  }

  /// As if there were no field, which led astray: straight on up to the triangles.
  Moving flown(const Moving& start) {
    const double step = constants_.step;
    const Vec3 gain = step * constants_.acceleration;
    Vec3 velocity = start.velocity + gain;
    const Leg leg{0, 1, start.position, start.position + step * (start.velocity + 0.5 * gain)};
    const auto met = first_met(leg);
    if (!met) return {leg.to, velocity};
    if (met->sheet->frame.is_moving()) return along(leg, *met, start, velocity);
    const Vec3 way = leg.to - leg.from;
    const double margin = 10 * apart * met->sheet->field->grid.cell * met->sheet->frame.scale;
    const Vec3 contact = leg.from + std::max(met->at - margin / norm(way), 0.0) * way;
    Vec3 rest = reflected((1 - met->at) * way, met->normal);
    velocity = reflected(velocity, met->normal);
    if (const auto other = first_met({0, 1, contact, contact + rest})) {
      rest = along_all(rest, std::array{met->normal, other->normal});
      velocity = reflected(velocity, other->normal);
    }
    const auto is_free = [&](Vec3 from) { return !first_met({0, 1, from, contact + rest}); };
    if (!is_free(contact) || !is_free(start.position)) rest = {};  // straight on, as is known
    const Vec3 to = contact + rest;
    return {to, afforded(velocity, start.velocity, to - start.position)};
  }

  /// The leg begins anew along with the sheet, less what leads through it and through others that
  /// are met then. In such a corner the velocity across its edge turns round; so does all of it
  /// where hardly any way is left, so that who came into a tip comes out again.
  Moving along(const Leg& leg, Met met, const Moving& start, Vec3 end_velocity) {
    const Object& sheet = *met.sheet;
    const double step = constants_.step;
    const Frame frame = frame_at(sheet.frame, step, 1);
    const auto at_end = [&](Vec3 p, double part) {
      const Frame then = frame_at(sheet.frame, step, part);
      return sheet.frame.is_moving() ? frame.to_world(then.to_object(p)) : p;
    };
    const Vec3 taken_along = at_end(leg.from, leg.begin), surface = frame.velocity_at(taken_along);
    const Vec3 before = start.velocity - sheet.frame.velocity_at(start.position);
    Vec3 way = slides_ ? at_end(leg.to, leg.end) - taken_along : Vec3{},
         velocity = end_velocity - surface;
    velocity = reflected(velocity, met.normal);
    std::array<Vec3, 3> normals{};
    for (std::size_t n = 0; n < normals.size(); ++n) {
      normals[n] = met.normal;
      const auto known = std::span(normals).first(n + 1);
      way = along_all(way, known);
      if (n > 0) {
        const Vec3 across = before - along_all(before, known);
        velocity = along_all(before + step * constants_.acceleration, known) -
                   constants_.restitution * across;
      }
      const auto other = first_met({leg.begin, 1, leg.from, taken_along + way});
      if (!other) break;
      met = *other;
    }
    const Vec3 gone = way + (leg.from - start.position);
    if (norm(gone) < hardly_any * step * norm(before)) velocity = -constants_.restitution * before;
    return {taken_along + way, surface + afforded(velocity, before, gone)};
  }

  /// A velocity, or a way, that leads into a surface.
  [[nodiscard]] Vec3 reflected(Vec3 v, Vec3 normal) const {
    return v - (1 + constants_.restitution) * std::min(dot(v, normal), 0.0) * normal;
  }
  /// As much of a velocity as somebody may have who had `before` and has gone that way since.
  [[nodiscard]] Vec3 afforded(Vec3 velocity, Vec3 before, Vec3 gone) const {
    const double square = dot(velocity, velocity),
                 most = std::max(dot(before, before) + 2 * dot(constants_.acceleration, gone), 0.0);
    return square > most ? std::sqrt(most / square) * velocity : velocity;
  }

  /// What is left of `way` along surfaces of these normals: of one its plane, of two their common
  /// edge, of three nothing.
  static Vec3 along_all(Vec3 way, std::span<const Vec3> normals) {
    if (normals.size() == 1) return way - dot(way, normals[0]) * normals[0];
    const Vec3 edge = normals.size() == 2 ? direction(cross(normals[0], normals[1])) : Vec3{};
    return dot(way, edge) * edge;
  }

  const RuleConstants& constants_;
  std::span<const Object> sheets_;
  bool slides_;     // else who is kept off stays: elsewhere a spring may hold more than he has
  bool knows_all_;  // there is no other surface
  std::vector<Crossing> crossings_;
};

/// Who of the particles p, p + 1, … went further than was known to be free.
lanes::L may_cross(const SheetScene& scene, const Start& start, const ParticleSpan& particles,
                   std::size_t p) {
  using namespace lanes;
  if (!scene.knows_free) return ~L{};
  D3 way = places(particles, p) - start.places(p);
  if (scene.setting == Setting::general)
    way = fma(all(-scene.constants.step), surface_velocities(scene.closest, p), way);
  const D free = max(to_double(load<F>(scene.closest.free + p)), D{});
  return settled(~(dot(way, way) <= free * free));
}

}  // namespace

Moved keep_off_sheets(const SheetScene& scene, const Start& start, std::vector<Waypoint>& waypoints,
                      const ParticleSpan& particles) {
  constexpr double never = HUGE_VAL;  // a part of the step that is not reached
  Guard guard(scene);
  std::vector<Leg> legs;
  Moved moved = Moved::none;
  const auto look_at = [&](std::size_t p) {
    const Vec3 end{particles.x[p], particles.y[p], particles.z[p]},
        velocity{particles.vx[p], particles.vy[p], particles.vz[p]};
    find_legs(p, start.position(p), waypoints, end, legs);
    if (!is_finite(end) || !is_finite(velocity)) return;
    const auto kept = guard.kept_off(legs, start.velocity(p), velocity);
    if (!kept) return;
    moved = Moved::some;
    const auto bends = std::ranges::equal_range(waypoints, p, {}, &Waypoint::particle);
    for (Waypoint& bend : std::ranges::drop_view(bends, static_cast<std::ptrdiff_t>(kept->leg)))
      bend.part = never;
    const auto& [position, reflected] = kept->at_end;
    particles.x[p] = position.x, particles.y[p] = position.y, particles.z[p] = position.z;
    particles.vx[p] = reflected.x, particles.vy[p] = reflected.y, particles.vz[p] = reflected.z;
  };
  for (std::size_t p = 0; p < particles.count; p += lanes::width) {
    const auto next = std::ranges::lower_bound(waypoints, p, {}, &Waypoint::particle);
    const bool bends = next != waypoints.end() && next->particle < p + lanes::width;
    const lanes::L may = bends ? ~lanes::L{} : may_cross(scene, start, particles, p);
    if (!lanes::any(may)) continue;
    for (int i = 0; i < lanes::width; ++i)
      if (may[i] != 0) look_at(p + static_cast<std::size_t>(i));
  }
  std::erase_if(waypoints, [](const Waypoint& bend) { return bend.part == never; });
  return moved;
}

}  // namespace tess::dn
