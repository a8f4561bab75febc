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
  /// With a compression the flat arrays are given up for the compressed field.
  void finish(const std::optional<Compression>& compression = {});

  /// The flat field; of a compressed one its outline.
  [[nodiscard]] const tess::dn::Field& field() const { return field_; }
  [[nodiscard]] const std::optional<tess::dn::CompressedField>& compressed() const {
    return compressed_;
  }
  /// What the step loop asks, for an object that stands there.
  [[nodiscard]] tess::dn::Object object(const tess::dn::Frame& frame) const {
    return {&field_, frame, compressed_ ? &*compressed_ : nullptr};
  }
  /// Bytes of the flat field, whether it is kept or not.
  [[nodiscard]] std::uint64_t flat_bytes() const { return flat_bytes_; }
  /// From begin() to finish().
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  std::optional<tess::dn::ExactBuilder> builder_;
  tess::dn::Field field_;
  std::optional<tess::dn::CompressedField> compressed_;
  std::uint64_t flat_bytes_ = 0;
  std::vector<tess::dn::BuiltSlab> slabs_;  // by part
  std::chrono::steady_clock::time_point start_;
  double seconds_ = 0;
};

/// A field that was built by one thread, and what it took.
struct BuiltField {
  tess::dn::Field field;
  double seconds = 0;
};
[[nodiscard]] BuiltField build_alone(const SceneObject& object, tess::dn::Content content);

[[nodiscard]] tess::dn::ErrorBound bound_of(const Compression& compression,
                                            const tess::dn::Field& field);

/// The signed distance at a point in the object's coordinates, interpolated between eight voxels;
/// HUGE_VAL outside the grid. Off by the square of the cell times the curvature, off the medial
/// axis.
[[nodiscard]] double distance_at(const tess::dn::Field& field, tess::dn::Vec3 p);
/// The same of an object's field, flat or compressed; its frame is not asked.
[[nodiscard]] double distance_at(const tess::dn::Object& object, tess::dn::Vec3 p);

/// A particle's way through the surface of an object in one step. It counts where the way reaches
/// more than a cell below the surface and began above it (fields of one side), or crosses a
/// triangle (of two sides). Nearer to the surface the field itself is not sure.
[[nodiscard]] bool passes_surface(const tess::dn::Object& object,
                                  const tess::dn::Surface& surface,
                                  tess::dn::Vec3 from,
                                  tess::dn::Vec3 to);

}  // namespace particles
