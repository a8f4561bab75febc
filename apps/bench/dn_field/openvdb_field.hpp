// OpenVDB's construction and lookup of the same field, for comparison; empty if the build did not
// find the library. Both run only on the calling thread, so its processor time is their whole cost.
#pragma once

#include "collide/dn_field/grid.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/dn_field/surface.hpp"

#include <cstddef>
#include <memory>
#include <optional>

namespace bench {

class OpenVdbField {
 public:
  /// The narrow band of `half_width` cells around `surface`, its voxels at multiples of the cell.
  [[nodiscard]] static std::optional<OpenVdbField> build(const tess::dn::Surface& surface,
                                                         const tess::dn::Grid& grid,
                                                         double half_width);

  [[nodiscard]] std::size_t n_voxels() const;

  /// Distances by the nearest voxel or trilinear, cut off at the band.
  void look_up(tess::dn::LookUp kind, const tess::dn::Points& points,
               std::span<float> distance) const;

 private:
  struct Library;
  explicit OpenVdbField(std::shared_ptr<const Library> library) : library_(std::move(library)) {}
  std::shared_ptr<const Library> library_;
};

}  // namespace bench
