// One round of a 3D blur with linear attenuation over the values of a grid.
#pragma once

#include "collide/dn_field/grid.hpp"

#include <span>

namespace tess::dn {

/// Blurs `before` into the layers `first` to `last` − 1 of `after`; both hold grid.size() values.
/// Values beyond the grid count as zero; the weights sum up to one. Different layers at once from
/// any threads; how the layers are split changes no value.
void blur_layers(const Grid& grid, int radius, std::span<const float> before,
                 std::span<float> after, int first, int last);

}  // namespace tess::dn
