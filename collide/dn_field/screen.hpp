// Who can feel a surface in this step at all. A cheap look at one voxel gives a lower bound of what
// the look-ups will say; most particles of a scene are further away than every rule reaches and
// than they fly, and are left to the loop without surfaces. The others are packed together, so that
// vectors are full of particles that need the work. Private to the step loop.
#pragma once

#include "collide/dn_field/closest.hpp"

#include <cstdint>

namespace tess::dn {

/// The particles of a block that may be near, packed.
struct Near {
  std::size_t count = 0;
  int unscreened = 0;                  ///< steps for which the block's particles all count as near
  std::uint32_t index[block_size];     ///< in the block, ascending
  alignas(64) float room[block_size];  ///< to the closest surface less what it moves in the step
  alignas(64) double values[6][block_size];

  /// The packed particles, rounded up to whole vectors.
  [[nodiscard]] ParticleSpan packed();
  /// What pack() took, back to its places.
  void unpack(const ParticleSpan& block);
};

/// How far rules reach and particles fly.
struct Reach {
  float distance = 0;  ///< of the rules, and what the acceleration adds to the way of a step
  float step = 0;
};

/// Lists who may be near; a NaN may.
void screen(std::span<const Placed> objects,
            LookUp kind,
            Sweep sweep,
            Reach reach,
            const ParticleSpan& block,
            Near& near);

/// Copies the listed particles.
void pack(const ParticleSpan& block, Near& near);

}  // namespace tess::dn
