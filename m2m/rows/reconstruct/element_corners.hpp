// A field in elements as a linear function in each of them, given at the corners of the tetrahedra that
// the elements were split into:  u(x) = u_E + g_E·(x - centroid of E).  The gradient is a linear fit
// to the elements that share a vertex with E, so linear fields are exact if their values are those at
// the centroids. The centroid is the mean over the volume, so the mean of an element stays.
#pragma once

#include "m2m/mesh_view.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

enum class CornerLimit : std::uint8_t {
  none,
  /// Shortens each gradient until the values at the element's vertices are within those of the
  /// elements that share a vertex with it (Barth and Jespersen 1989).
  neighbours,
};

/// The layers of tetrahedra that a part holds around its own, so that the result does not depend on
/// how the mesh is cut. With elements that were split: the rest of the element, its neighbours, and
/// the rest of these.
[[nodiscard]] constexpr std::int32_t element_halo_layers(bool is_split) noexcept {
  return is_split ? 3 : 1;
}

/// `elements`: the element of each tetrahedron, as global ids. `values`: tetrahedra × n_components;
/// those of an element are alike. Returns 4 tetrahedra × n_components (Centring::corners); zeros
/// for elements of which the part owns nothing.
[[nodiscard]] std::vector<double> element_corners(MeshView mesh, std::span<const GlobalId> elements,
                                                  std::span<const double> values,
                                                  std::size_t n_components, CornerLimit limit);

}  // namespace tess::m2m
