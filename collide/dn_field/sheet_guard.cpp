#include "collide/dn_field/sheet_guard.hpp"

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/leg.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace tess::dn {
namespace {

constexpr double apart = 1e-6;  // of a cell: nearer to a sheet nobody is left

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

/// Where particles stand when a step ends, and how fast they are.
struct Moving {
  Vec3 position, velocity;
};

class Guard {
 public:
  Guard(const RuleConstants& constants, std::span<const Object> sheets)
      : constants_(constants), sheets_(sheets) {}

  /// Where a particle is to be that meets a sheet; none where it does not. `legs`: its way, in the
  /// order of time.
  std::optional<Moving> kept_off(std::span<const Leg> legs, Vec3 velocity, Vec3 end_velocity) {
    for (const Leg& leg : legs)
      if (const auto met = first_met(leg))
        return along(leg, *met, {legs[0].from, velocity}, end_velocity);
    return std::nullopt;
  }

 private:
  struct Met {
    const Object* sheet;
    Vec3 normal;  // of the triangle, against the way; in the world, when the step ends
  };

  std::optional<Met> first_met(const Leg& leg) {
    for (const Object& sheet : sheets_)
      if (const auto normal = crossed(sheet, leg))
        return Met{&sheet, frame_at(sheet.frame, constants_.step, 1).rotate(*normal)};
    return std::nullopt;
  }

  /// The normal of the first triangle on the way, in the object's coordinates.
  std::optional<Vec3> crossed(const Object& sheet, const Leg& leg) {
    const double margin = apart * sheet.field->grid.cell;
    std::optional<Vec3> found;
    any_piece(sheet.frame, constants_.step, leg, [&](Vec3 from, Vec3 to) {
      const Vec3 way = to - from;
      const double length = norm(way);
      if (!(length > 0) || free_around(sheet, from) > length + margin) return false;
      crossings_.clear();
      sheet.triangles->crossings(from, to + (margin / length) * way, crossings_);
      if (crossings_.empty()) return false;
      const Crossing first = *std::ranges::min_element(crossings_, {}, &Crossing::at);
      const Vec3 normal = sheet.triangles->normal(first.triangle);
      found = dot(normal, way) > 0 ? -normal : normal;
      return true;
    });
    return found;
  }

  /// The leg begins anew along with the sheet, less what leads through it and through others that
  /// are met then.
  Moving along(const Leg& leg, Met met, const Moving& start, Vec3 end_velocity) {
    const Object& sheet = *met.sheet;
    const double step = constants_.step;
    const Frame frame = frame_at(sheet.frame, step, 1);
    const auto at_end = [&](Vec3 p, double part) {
      const Frame then = frame_at(sheet.frame, step, part);
      return sheet.frame.is_moving() ? frame.to_world(then.to_object(p)) : p;
    };
    const Vec3 taken_along = at_end(leg.from, leg.begin), surface = frame.velocity_at(taken_along);
    Vec3 way = at_end(leg.to, leg.end) - taken_along, velocity = end_velocity - surface;
    std::array<Vec3, 3> normals{};
    for (std::size_t n = 0; n < normals.size(); ++n) {
      normals[n] = met.normal;
      const double sinks = std::min(dot(velocity, met.normal), 0.0);
      velocity += -(1 + constants_.restitution) * sinks * met.normal;
      way = along_all(way, std::span(normals).first(n + 1));
      const auto other = first_met({leg.begin, 1, leg.from, taken_along + way});
      if (!other) break;
      met = *other;
    }
    const Vec3 before = start.velocity - sheet.frame.velocity_at(start.position),
               gone = way + (leg.from - start.position);
    const double energy = dot(before, before) + 2 * dot(constants_.acceleration, gone),
                 square = dot(velocity, velocity);
    if (square > std::max(energy, 0.0))
      velocity = std::sqrt(std::max(energy, 0.0) / square) * velocity;
    return {taken_along + way, surface + velocity};
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
  std::vector<Crossing> crossings_;
};

/// Who of the particles p, p + 1, … went further than was known to be free.
lanes::L may_cross(const SheetScene& scene,
                   const Start& start,
                   const ParticleSpan& particles,
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

void keep_off_sheets(const SheetScene& scene,
                     const Start& start,
                     std::vector<Waypoint>& waypoints,
                     const ParticleSpan& particles) {
  constexpr std::size_t nobody = block_size;
  Guard guard(scene.constants, scene.sheets);
  auto next = waypoints.begin();
  std::vector<Leg> legs;
  const auto look_at = [&](std::size_t p) {
    const Vec3 end{particles.x[p], particles.y[p], particles.z[p]},
        velocity{particles.vx[p], particles.vy[p], particles.vz[p]};
    legs.assign(1, {0, 1, start.position(p), end});
    const auto first = next;
    for (; next != waypoints.end() && next->particle == p; ++next) {
      legs.back().end = next->part, legs.back().to = next->place;
      legs.push_back({next->part, 1, next->place, end});
    }
    if (!is_finite(end) || !is_finite(velocity)) return;
    const auto kept = guard.kept_off(legs, start.velocity(p), velocity);
    if (!kept) return;
    std::for_each(first, next, [](Waypoint& passed) { passed.particle = nobody; });
    particles.x[p] = kept->position.x, particles.y[p] = kept->position.y;
    particles.z[p] = kept->position.z;
    particles.vx[p] = kept->velocity.x, particles.vy[p] = kept->velocity.y;
    particles.vz[p] = kept->velocity.z;
  };
  for (std::size_t p = 0; p < particles.count; p += lanes::width) {
    const bool bend = next != waypoints.end() && next->particle < p + lanes::width;
    const lanes::L may = bend ? ~lanes::L{} : may_cross(scene, start, particles, p);
    if (!lanes::any(may)) continue;
    for (int i = 0; i < lanes::width; ++i)
      if (may[i] != 0) look_at(p + static_cast<std::size_t>(i));
  }
  std::erase_if(waypoints, [](const Waypoint& passed) { return passed.particle == nobody; });
}

}  // namespace tess::dn
