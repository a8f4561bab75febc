// A surface whose closed parts bound what they enclose, whichever way their triangles were given:
// what a one-sided field is built from. A part is closed where an even number of triangles meets at
// each of its edges, flipped or not. Around its surface it winds, on the mean of both sides, +1/2
// where its normals point out of a body, −1/2 where they point into one that nothing else
// encloses: then the whole part is turned. A cavity's faces point into the cavity; the body around
// it makes that mean +1/2 too, so they stay. After this the inside is where the winding number is
// above 1/2, and normals of triangles, crossings and estimates agree about it.
//
// Rejected: |winding| > 1/2 as the inside. It makes solid the hollow of an open dish, pipe or room
// whose normals point into it, and leaves the normals of triangles as they are. Open parts are
// taken at their word.
#pragma once

#include "collide/dn_field/surface.hpp"

#include <optional>

namespace tess::dn {

class OutwardSurface {
 public:
  /// `given` must be valid and outlive this.
  explicit OutwardSurface(const Surface& given);

  /// The triangles of `given` in their order. Vertices of equal position are merged, unless it is
  /// closed without.
  [[nodiscard]] const Surface& surface() const { return own_ ? *own_ : given_; }

  /// Whether surface() is (see tess::dn::is_closed).
  [[nodiscard]] bool is_closed() const { return closed_; }

 private:
  const Surface& given_;
  std::optional<Surface> own_;
  bool closed_ = false;
};

}  // namespace tess::dn
