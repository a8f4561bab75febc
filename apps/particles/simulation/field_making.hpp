// The fields of a scene's objects in the making: built once a process by all its PEs, or read from
// a file, then only read.
#pragma once

#include "apps/particles/scene/scene.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/compressed.hpp"

#include <chrono>
#include <optional>

namespace particles {

/// The content of the fields of this scene: what its rules need, and normals for compression,
/// pictures and files.
[[nodiscard]] tess::dn::Content content_of(const Scene& scene);

/// The field of an object in the making: begun by one PE of the process, filled by all in stages,
/// finished by one. The field does not depend on how many there are.
class FieldInTheMaking {
 public:
  /// The part of one PE: the tree of triangles and, for the methods that blur, the voxels of the
  /// surface; or the whole field from a file.
  void begin(const SceneObject& object, tess::dn::Content content, int n_parts);
  /// Known once begun; none for a field from a file.
  [[nodiscard]] int n_stages() const;
  /// Fills a part in a stage, if the part exists. PEs fill different parts at the same time, and
  /// all before the next stage begins.
  void fill(int stage, int part);
  /// With a compression, the field is compressed.
  void finish(const std::optional<Compression>& compression);

  [[nodiscard]] const tess::dn::Field& field() const { return field_; }
  /// Bytes of the flat field, also where the compressed one has replaced it.
  [[nodiscard]] std::uint64_t flat_bytes() const { return flat_bytes_; }
  /// From begin() to finish().
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  std::optional<tess::dn::FieldBuilder> builder_;  // none for a field from a file
  tess::dn::Field field_;
  std::uint64_t flat_bytes_ = 0;
  int n_parts_ = 0;
  tess::dn::Grid grid_;
  std::chrono::steady_clock::time_point start_;
  double seconds_ = 0;
};

/// The flat field, built by this thread or read from its file, which has what `content` asks for.
[[nodiscard]] tess::dn::Field build_alone(const SceneObject& object, tess::dn::Content content);

[[nodiscard]] tess::dn::ErrorBound bound_of(const Compression& compression,
                                            const tess::dn::Field& field);

}  // namespace particles
