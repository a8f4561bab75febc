// First pass of a step over a block of particles: asks each object's field, keeps the closest
// surface of each particle, in world coordinates. The second pass (rule_loop.hpp) reads it from the
// cache. Private to the step loop.
#pragma once

#include "collide/dn_field/field/compressed_sample.hpp"
#include "collide/dn_field/rules/particle_lanes.hpp"
#include "collide/dn_field/stepper.hpp"

namespace tess::dn {

inline constexpr std::size_t block_size = 256;  // with the particles, 20 to 30 kB: the first cache

/// Of each particle of a block.
struct alignas(64) Closest {
  float distance[block_size];                            ///< out_of_reach where no field is
  float nx[block_size], ny[block_size], nz[block_size];  ///< unit or zero
  float free[block_size];  ///< swept impact only: no surface is met in this step on a shorter way
                           ///< relative to the velocity below; `follow`: one may be on any
  // One object at rest, look-ups of one voxel's distance and normal: most particles are still in
  // the voxel of the step before, which then need not be fetched and decoded again.
  std::int32_t voxel[block_size];                         ///< that the above is of, see forget()
  float stored[block_size];                               ///< its distance
  double ux[block_size], uy[block_size], uz[block_size];  ///< the surface's velocity (General only)
};

/// Of Closest::free: the particle must be traced, even at rest; another object comes fast.
inline constexpr float follow = -out_of_reach;

/// An object of one step as the loops see it. Positions are taken relative to the grid's centre in
/// double precision before they are rounded to float.
struct Placed {
  Sampler field;
  PlaneSampler planes;   ///< of a compressed field; then `field` gives sizes alone
  Vec3 centre;           ///< of the grid, in the world
  float to_grid[3][3];   ///< rows: grid coordinates of a world vector
  float middle[3];       ///< grid coordinates of the centre
  float to_world[3][3];  ///< rows: a normal in the world
  float scale;           ///< world units per unit of the object
  float cell;            ///< in world units
  float padding;         ///< taken off the distance to a sheet that is met from either side
  bool compressed;
  float error;  ///< how far a compressed voxel may be off; in world units
  float doubt;  ///< that, and half a voxel's diagonal
  float jump;   ///< jump_of(), in world units
  Frame frame;
  double step;    ///< the time of which this is the begin
  double growth;  ///< of the scale in it, as a part of the scale
  float spin;     ///< by which it turns in it
  double swell;   ///< no surface moves faster by growth
  bool restless;  ///< some object of the scene moves

  /// Whether straight ways are none as the object sees them.
  [[nodiscard]] bool bends() const { return spin != 0 || growth != 0; }
};

/// Field::jump of what look-ups in this object read, in its own units.
[[nodiscard]] double jump_of(const Object& object);

/// How `object` stands for a step; `restless`: whether any object of the scene moves.
[[nodiscard]] Placed placed(const Object& object, LookUp kind, double step, bool restless);

/// Whether positions must be turned, surfaces move, or several objects be compared.
enum class Setting : std::uint32_t { one_at_rest, general };

/// How the fields of a scene are stored.
enum class Storage : std::uint32_t { flat, compressed };
[[nodiscard]] inline Storage storage_of(std::span<const Object> objects) {
  return !objects.empty() && objects[0].compressed != nullptr ? Storage::compressed : Storage::flat;
}

/// Writes `closest`; `last`, which may be the same, is what the look-up before found of these
/// particles: it saves time and changes nothing.
using ClosestPass = void (*)(const Placed&, const ParticleSpan&, const Closest& last,
                             Closest& closest);

/// The pass for one object; `general` passes keep what is closer and start from clear().
/// Compressed fields have no trilinear one.
[[nodiscard]] ClosestPass closest_pass(LookUp kind, Ask asked, Setting setting, Sweep sweep,
                                       Storage storage);

/// To be called where lanes get other particles: no voxel is known.
void forget(Closest& closest, std::size_t count);

/// No surface anywhere.
void clear(Closest& closest, std::size_t count);

namespace lanes {

/// The closest surfaces of particles p, p + 1, …: their normals and velocities.
inline F3 normals(const Closest& closest, std::size_t p) {
  return {load<F>(closest.nx + p), load<F>(closest.ny + p), load<F>(closest.nz + p)};
}
inline D3 surface_velocities(const Closest& closest, std::size_t p) {
  return load3(closest.ux + p, closest.uy + p, closest.uz + p);
}

}  // namespace lanes

}  // namespace tess::dn
