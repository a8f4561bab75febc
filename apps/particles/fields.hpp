// The fields of a scene's objects, built once a process and read by all its PEs, and what they say
// of a point: what the audit and the statistics ask, one point at a time. The step loop has its own
// look-ups.
#pragma once

#include "apps/particles/scene.hpp"
#include "collide/dn_field/stepper.hpp"

#include <vector>

namespace particles {

/// The field of an object, and what it cost.
struct BuiltField {
  tess::dn::Field field;
  double seconds = 0;
};

/// What the fields of this scene must hold: what its rules need, and normals for a picture.
[[nodiscard]] tess::dn::Content content_of(const Scene& scene);

/// Builds the field of one object by the method it names.
[[nodiscard]] BuiltField build(const SceneObject& object, tess::dn::Content content);

/// The signed distance at a point in the object's coordinates, interpolated between eight voxels;
/// HUGE_VAL outside the grid. Off by the square of the cell times the curvature, off the medial
/// axis.
[[nodiscard]] double distance_at(const tess::dn::Field& field, tess::dn::Vec3 p);

/// A particle's way through the surface of an object in one step. It counts where the way reaches
/// more than a cell below the surface and began above it (fields of one side), or crosses a
/// triangle (of two sides). Nearer to the surface the field itself is not sure.
[[nodiscard]] bool passes_surface(const tess::dn::Field& field,
                                  const tess::dn::Surface& surface,
                                  tess::dn::Vec3 from,
                                  tess::dn::Vec3 to);

}  // namespace particles
