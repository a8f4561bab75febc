// Orientation repair: turns closed parts of a surface that are inside out, before a one-sided field
// is built from it. A part is closed if an even number of triangles meets at each of its edges. The
// winding number at its surface, as the mean of both sides, is +1/2 if its normals point out of a
// body and −1/2 if they point into one that nothing else encloses; in the latter case the whole
// part is turned. The faces of a cavity point into the cavity; with the body around it their mean
// is +1/2, too. Afterwards the inside is where the winding number exceeds 1/2.
//
// Rejected: |winding number| > 1/2 as the inside. It would fill an open dish, pipe or room with
// normals that point into it. Open parts are never turned.
#pragma once

#include "collide/dn_field/surface.hpp"

#include <optional>

namespace tess::dn {

class OutwardSurface {
 public:
  /// `given` must be valid and outlive this.
  explicit OutwardSurface(const Surface& given);

  /// The triangles of `given` in their order. Vertices with equal positions are merged unless
  /// `given` is closed.
  [[nodiscard]] const Surface& surface() const { return own_ ? *own_ : given_; }

  /// Whether surface() is closed (see tess::dn::is_closed).
  [[nodiscard]] bool is_closed() const { return closed_; }

 private:
  const Surface& given_;
  std::optional<Surface> own_;
  bool closed_ = false;
};

}  // namespace tess::dn
