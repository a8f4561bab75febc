// What keeps particles on their side of a sheet where the field alone cannot: a voxel knows one
// surface, so that where sheets meet, or come within a cell of one another, the look-up may know
// the wrong one. After an impact's step the way of each particle that came near is held against the
// triangles; who would cross one slides along it, or stays where he was. It costs nothing where no
// object has triangles to be held against. Private to the step loop.
#pragma once

#include "collide/dn_field/step/moments.hpp"
#include "collide/dn_field/step/start.hpp"

namespace tess::dn {

/// What a step begins with.
struct SheetScene {
  const RuleConstants& constants;
  std::span<const Object> sheets;  ///< as they stand then
  Setting setting;
  const Closest& closest;  ///< of the particles where they stand then
  bool knows_free;         ///< whether it holds Closest::free
  bool springs;            ///< whether there are any
  bool sheets_alone;       ///< there are no other objects
};

/// Who crossed a triangle of a sheet is put back to its own side and reflected, with no more energy
/// than at the start. `waypoints`: by particle and time; leaves out those
/// that who was put elsewhere did not reach.
Moved keep_off_sheets(const SheetScene& scene, const Start& start, std::vector<Waypoint>& waypoints,
                      const ParticleSpan& particles);

}  // namespace tess::dn
