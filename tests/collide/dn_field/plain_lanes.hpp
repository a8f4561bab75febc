// What plain_lanes.cpp offers to the test that compares instruction sets.
#pragma once

#include "collide/dn_field/rules/rule_loop.hpp"

namespace tess::dn::plain {

/// All rules at once, without wide vectors.
void loop(const RuleConstants& constants, const ParticleSpan& particles,
          const NearestSurface& nearest, Scratch& scratch);

inline constexpr int sample_count = 512;

/// points: x, y, z of sample_count points, in grid coordinates; out: distance and normal.
void samples(const Field& field, LookUp kind, const float* points, float* out);

}  // namespace tess::dn::plain
