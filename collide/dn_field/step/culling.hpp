// Culling: which particles may feel a surface in the next steps. One voxel gives a lower bound of
// the distances that these steps will sample; Field::jump bounds the change from voxel to voxel.
// Most particles of a scene are further away than all rules reach and than they fly, and go to the
// free loop. The others are packed, so that vectors are full. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/nearest_surface.hpp"

#include <algorithm>
#include <cstdint>

namespace tess::dn {

/// Positions and velocities, an array per axis.
struct ParticleRoom {
  alignas(64) double values[6][block_size];

  [[nodiscard]] ParticleSpan span(std::size_t count) {
    return {values[0], values[1], values[2], values[3], values[4], values[5], count};
  }
};

/// Copies from.count particles.
inline void copy(const ParticleSpan& from, const ParticleSpan& to) {
  for (std::size_t a = 0; a < 6; ++a) std::copy_n(from.columns()[a], from.count, to.columns()[a]);
}

/// The particles of a block that may be near, packed.
struct NearParticles {
  std::size_t count = 0;
  std::uint32_t index[block_size];     ///< in the block; those near in the first step come first
  alignas(64) float room[block_size];  ///< displacement below which no surface is felt
  ParticleRoom packed;

  /// Copies the listed particles, and fills up whole vectors.
  ParticleSpan pack(const ParticleSpan& block);
  /// Copies the packed particles back into the block.
  void unpack(const ParticleSpan& block) const;
};

/// How far rules reach and particles fly.
struct Reach {
  float distance = 0;  ///< at which the first rule acts
  float time = 0;      ///< length of the steps
  float gain = 0;      ///< upper bound of the speed gained in that time
  bool ahead = false;  ///< whether fields are sampled again after the start of the first step
};

/// Lists the particles that may be near a surface within `reach.time`; a NaN counts as near.
void cull(std::span<const PlacedObject> objects, LookUp kind, Sweep sweep, Reach reach,
          const ParticleSpan& block, NearParticles& near);

}  // namespace tess::dn
