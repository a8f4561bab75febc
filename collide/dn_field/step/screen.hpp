// Who can feel a surface at all in the next step, or in several. A cheap look at one voxel gives a
// lower bound of what the look-ups will say; most particles of a scene are further away than every
// rule reaches and than they fly, and are left to the loop without surfaces. The others are packed
// together, so that vectors are full of particles that need the work. The bound of later look-ups
// counts with Field::jump for every voxel that the particle may come to. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/closest.hpp"

#include <cstdint>

namespace tess::dn {

/// The particles of a block that may be near, packed.
struct Near {
  std::size_t count = 0;
  std::uint32_t index[block_size];     ///< in the block; first who may be near at once
  alignas(64) float room[block_size];  ///< may be flown without feeling a surface
  alignas(64) double values[6][block_size];

  /// The packed particles, rounded up to whole vectors.
  [[nodiscard]] ParticleSpan packed();
  /// What pack() took, back to its places.
  void unpack(const ParticleSpan& block);
};

/// How far rules reach and particles fly.
struct Reach {
  float distance = 0;  ///< of the rules
  float time = 0;      ///< of the steps
  float gain = 0;      ///< of speed in that time, at most
  bool ahead = false;  ///< there are look-ups after the first: of later steps, of the step's end
};

/// Lists who may be near within `reach.time` from now; a NaN may.
void screen(std::span<const Placed> objects, LookUp kind, Sweep sweep, Reach reach,
            const ParticleSpan& block, Near& near);

/// Copies the listed particles.
void pack(const ParticleSpan& block, Near& near);

}  // namespace tess::dn
