// OpenVDB's construction of the same field, to stand beside ours; nothing where the build did not
// find the library.
#pragma once

#include "collide/dn_field/grid.hpp"
#include "collide/dn_field/surface.hpp"

#include <cstddef>
#include <optional>

namespace bench {

/// Makes OpenVDB's narrow band of `half_width` cells around `surface` and returns the number of
/// its voxels.
[[nodiscard]] std::optional<std::size_t> openvdb_build(const tess::dn::Surface& surface,
                                                       const tess::dn::Grid& grid,
                                                       double half_width);

}  // namespace bench
