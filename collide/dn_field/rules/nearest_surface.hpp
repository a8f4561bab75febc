// First pass of a step over a block of particles: samples the field of each object and keeps the
// nearest surface of each particle, in world coordinates. The second pass (rule_loop.hpp) reads it
// from the cache. Private to the step loop.
#pragma once

#include "collide/dn_field/field/compressed_sample.hpp"
#include "collide/dn_field/stepper.hpp"

namespace tess::dn {

inline constexpr std::size_t block_size = 256;  // with the particles 20 to 30 kB, for the L1 cache

/// The nearest surface of each particle of a block.
struct alignas(64) NearestSurface {
  float distance[block_size];                            ///< out_of_reach outside all fields
  float nx[block_size], ny[block_size], nz[block_size];  ///< unit or zero
  /// Sweep::on only: a displacement below this, relative to the velocity below, is not stopped in
  /// this step. `follow`: any displacement may be.
  float free[block_size];
  // One object at rest, samples of one voxel: most particles are still in the voxel of the step
  // before, which is then not fetched and decoded again.
  std::int32_t voxel[block_size];                         ///< the sampled voxel; see forget()
  float stored[block_size];                               ///< its distance
  double ux[block_size], uy[block_size], uz[block_size];  ///< surface's velocity; general only
};

/// NearestSurface::free of a particle that is always traced: another object approaches fast.
inline constexpr float follow = -out_of_reach;

/// An object at the start of a step, as the loops read it. Positions are taken relative to the
/// grid's centre in double precision before they are rounded to float.
struct PlacedObject {
  Sampler field;
  PlaneSampler planes;   ///< of a compressed field; `field` then holds only the sizes
  Vec3 centre;           ///< of the grid, in the world
  float to_grid[3][3];   ///< rows: grid coordinates of a world vector
  float middle[3];       ///< grid coordinates of the centre
  float to_world[3][3];  ///< rows: a normal in the world
  float scale;           ///< world units per unit of the object
  float cell;            ///< in world units
  float padding;         ///< subtracted from the distance to an open surface
  float stopped;         ///< the distance at which particles are stopped, padding included
  bool compressed;
  float error;  ///< largest error of a compressed voxel's distance, in world units
  float doubt;  ///< that plus half a voxel's diagonal
  float jump;   ///< jump_of(), in world units
  Frame frame;
  double step;    ///< length of the step in time
  double growth;  ///< relative change of the scale in the step
  float spin;     ///< rotation in the step, radians
  double swell;   ///< upper bound of the surface's speed by growth
  bool restless;  ///< whether some object of the scene moves

  /// Whether a straight path in the world is curved in the object's coordinates.
  [[nodiscard]] bool bends() const { return spin != 0 || growth != 0; }
};

/// Field::jump of the samples of a field, compressed or not.
[[nodiscard]] double jump_of(const Field& field);

/// `object` at the start of a step; `restless`: whether any object of the scene moves; `threshold`:
/// of the impact.
[[nodiscard]] PlacedObject placed(const Object& object, LookUp kind, double step, bool restless,
                                  double threshold);

/// one_at_rest: one object that neither moves nor is turned.
enum class Setting : std::uint32_t { one_at_rest, general };

/// Writes `nearest`. `last` is the result of the previous pass over these particles, and may be the
/// same object; it saves time and does not change the result.
using NearestPass = void (*)(const PlacedObject&, const ParticleSpan&, const NearestSurface& last,
                             NearestSurface& nearest);

/// The pass over one object; a general pass keeps the nearer surface and starts from clear().
/// There is no trilinear pass over compressed fields.
[[nodiscard]] NearestPass nearest_pass(LookUp kind, Ask asked, Setting setting, Sweep sweep,
                                       bool compressed);

/// Must be called when lanes get other particles: no voxel is cached.
void forget(NearestSurface& nearest, std::size_t count);

/// Sets no surface everywhere.
void clear(NearestSurface& nearest, std::size_t count);

namespace lanes {

// The nearest surfaces of particles p, p + 1, ….
inline F3 normals(const NearestSurface& nearest, std::size_t p) {
  return {load<F>(nearest.nx + p), load<F>(nearest.ny + p), load<F>(nearest.nz + p)};
}
inline D3 surface_velocities(const NearestSurface& nearest, std::size_t p) {
  return load3(nearest.ux + p, nearest.uy + p, nearest.uz + p);
}

/// m v, row by row.
[[gnu::always_inline]] inline F3 times(const float (&m)[3][3], F3 v) {
  const auto row = [&](int i) { return v.x * m[i][0] + v.y * m[i][1] + v.z * m[i][2]; };
  return {row(0), row(1), row(2)};
}

/// A vector of the world in grid coordinates.
[[gnu::always_inline]] inline F3 turned_to_grid(const PlacedObject& object, F3 v) {
  return times(object.to_grid, v);
}

/// Grid coordinates of the world's points `object.centre` + q.
[[gnu::always_inline]] inline F3 to_grid(const PlacedObject& object, F3 q) {
  const F3 g = turned_to_grid(object, q);
  return {g.x + object.middle[0], g.y + object.middle[1], g.z + object.middle[2]};
}

/// A vector of the object in the world, at scale 1.
[[gnu::always_inline]] inline F3 to_world(const PlacedObject& object, F3 n) {
  return times(object.to_world, n);
}

/// A sample's distance in world units; out_of_reach outside the field.
inline F distance_in_world(const PlacedObject& object, const Sample& found) {
  return found.in ? found.distance * object.scale - object.padding : all(out_of_reach);
}
/// Lower bound of the distance to the grid's box, also after the rounding of large coordinates.
inline F outside_by(const PlacedObject& object, F3 g) {
  const auto beyond = [](F at, int n) { return max(-at, at - static_cast<float>(n - 1)); };
  return 0.999999F * object.cell *
         max(max(beyond(g.x, object.field.n[0]), beyond(g.y, object.field.n[1])),
             max(beyond(g.z, object.field.n[2]), F{}));
}

/// Lower bound of the way to a place where particles are stopped, or to the field.
inline F free_in_world(const PlacedObject& object, const Sample& found, F3 g) {
  return found.in ? found.free * object.scale - (object.error + object.stopped)
                  : outside_by(object, g);
}

inline D3 cross(Vec3 a, D3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Velocity of the object at points `arm` from its origin, without that of growth.
inline D3 stiff_velocity(const Frame& f, D3 arm) {
  return all(f.velocity) + cross(f.angular_velocity, arm);
}

}  // namespace lanes
}  // namespace tess::dn
