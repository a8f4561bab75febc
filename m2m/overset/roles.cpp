#include "m2m/overset/roles.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>

namespace tess::m2m {

std::vector<Role> roles_of(const MeshView& mesh, std::span<const Wall> walls,
                           std::span<const std::uint8_t> on_outer, std::int32_t fringe_layers,
                           std::span<const SymmetryPlane> symmetry) {
  const std::size_t n = mesh.points.size();
  TESS_CHECK(on_outer.empty() || on_outer.size() == n, "expected ", n,
             " flags of the outer boundary, got ", on_outer.size());
  std::vector<Role> roles(n, Role::field);
  constexpr std::int32_t far = -1;
  std::vector<std::int32_t> layer(n, far);  // edges to the nearest hole; 1 on the outer boundary
  for (std::size_t v = 0; v < n; ++v) {
    const Point& p = mesh.points[v];
    const auto is_inside = [&](const Wall& w) { return w.locate(p) != Containment::outside; };
    const auto is_outside = [&](const SymmetryPlane& plane) { return plane.is_beyond(p); };
    const bool is_hole = std::any_of(symmetry.begin(), symmetry.end(), is_outside) ||
                         std::any_of(walls.begin(), walls.end(), is_inside);
    if (is_hole) roles[v] = Role::hole;
    if (is_hole)
      layer[v] = 0;
    else if (!on_outer.empty() && on_outer[v] != 0)
      layer[v] = 1;
  }
  for (std::int32_t k = 1; k <= fringe_layers; ++k)
    for (const Tet& tet : mesh.tets) {
      const auto layer_at = [&](VertexId v) -> std::int32_t& {
        return layer[static_cast<std::size_t>(v)];
      };
      if (std::none_of(tet.begin(), tet.end(), [&](VertexId v) { return layer_at(v) == k - 1; }))
        continue;
      for (const VertexId v : tet)
        if (layer_at(v) == far) layer_at(v) = k;
    }
  for (std::size_t v = 0; v < n; ++v)
    if (layer[v] > 0 && layer[v] <= fringe_layers) roles[v] = Role::fringe;
  return roles;
}

}  // namespace tess::m2m
