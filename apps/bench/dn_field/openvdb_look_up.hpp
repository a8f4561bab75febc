// Our lookups and OpenVDB's in one field, run in turn; empty if the build did not find the library.
#pragma once

#include "apps/bench/report.hpp"
#include "collide/dn_field/grid.hpp"
#include "collide/dn_field/surface.hpp"

namespace bench {

/// Nearest and trilinear distances of points all over `grid`, in bands of `half_width` cells. The
/// fastest of each is compared with the other: 25 % is allowed.
void look_up_beside_openvdb(Report& report, const tess::dn::Surface& surface,
                            const tess::dn::Grid& grid, double half_width, int repeat);

}  // namespace bench
