// One round of a 3D blur with linear attenuation over the values of a grid.
#pragma once

#include "collide/dn_field/build_plan.hpp"

#include <span>
#include <vector>

namespace tess::dn {

/// Values beyond the grid count as zero; the weights sum up to one. values: grid.size().
void blur_once(const Grid& grid, int radius, std::vector<float>& values);

}  // namespace tess::dn
