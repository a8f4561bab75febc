// Room for the particles of a block, apart from the block itself. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/nearest_surface.hpp"

#include <algorithm>

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

}  // namespace tess::dn
