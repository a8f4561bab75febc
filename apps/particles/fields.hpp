// The fields of a scene's objects, built once a process and read by all its PEs, and what they say
// of a point: what the audit and the statistics ask, one point at a time. The step loop has its own
// look-ups.
#pragma once

#include "apps/particles/scene.hpp"
#include "collide/dn_field/build_exact.hpp"
#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/stepper.hpp"

#include <chrono>
#include <optional>
#include <vector>

namespace particles {

/// What the fields of this scene must hold: what its rules need, and normals for a picture.
[[nodiscard]] tess::dn::Content content_of(const Scene& scene);

/// The field of an object in the making: begun by one PE of the process, its layers filled by all,
/// finished by one. The field does not depend on how many there are.
class FieldInTheMaking {
 public:
  /// The part that is one PE's: a tree of the triangles, and which voxels are inside; the whole
  /// field by the methods that blur.
  void begin(const SceneObject& object, tess::dn::Content content, int n_parts);
  /// Fills one of the parts; different ones at once.
  void fill(int part);
  void finish();

  [[nodiscard]] const tess::dn::Field& field() const { return field_; }
  /// From begin() to finish().
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  std::optional<tess::dn::ExactBuilder> builder_;
  tess::dn::Field field_;
  std::vector<double> furthest_;  // by part
  std::chrono::steady_clock::time_point start_;
  double seconds_ = 0;
};

/// A field that was built by one thread, and what it took.
struct BuiltField {
  tess::dn::Field field;
  double seconds = 0;
};
[[nodiscard]] BuiltField build_alone(const SceneObject& object, tess::dn::Content content);

/// How far the voxels of a compressed field may be off: an eighth of a cell and 3 degrees, no more
/// than nearest look-up adds by itself.
[[nodiscard]] tess::dn::ErrorBound usual_bound(const tess::dn::Field& field);

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
