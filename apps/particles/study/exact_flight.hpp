// The reference of the study for rules that act at a distance: flights in front of the triangles
// themselves, no field. Along a straight way a linear drag takes as much speed per length as its
// rate: a closed form but for where its reach begins, which exact distances give to rounding. The
// surface flow is followed in short steps of second order with exact normals.
#pragma once

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/rules.hpp"

namespace particles {

struct Flight {
  tess::dn::Vec3 position, velocity;
};

/// After `time`, slowed down by the drag, which is linear, nearer than its threshold.
[[nodiscard]] Flight exact_drag(const tess::dn::Bvh& tree, const Flight& start,
                                const tess::dn::SurfaceDrag& drag, double time);

/// After `time`, turned by the flow; its error falls with the square of n_steps.
[[nodiscard]] Flight exact_flow(const tess::dn::Bvh& tree, const Flight& start,
                                const tess::dn::SurfaceFlow& flow, double time, int n_steps);

}  // namespace particles
