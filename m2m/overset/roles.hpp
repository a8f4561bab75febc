// The role of each point of an overset mesh: computed, interpolated, or blanked.
#pragma once

#include "m2m/mesh_view.hpp"
#include "m2m/overset/wall.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

enum class Role : std::uint8_t {
  field,   ///< the application computes its value
  fringe,  ///< its value is interpolated from another mesh
  hole     ///< inside or on a wall of another mesh, or beyond a plane of symmetry: its value means
           ///< nothing, but must be finite
};

/// How a mesh takes part.
struct BlankingOptions {
  std::int32_t fringe_layers = 1;         ///< as deep as the application's stencil reaches
  double least_quality = 0;               ///< donors below it are refused (Blanking::quality())
  std::vector<SymmetryPlane> symmetry{};  ///< sides of the domain: the same for all meshes
};

/// The roles of all points of `mesh`. Points inside or on one of `walls`, those of other meshes, and
/// points beyond planes of symmetry are holes. Fringe are the points within so many edges of a hole,
/// and those on the outer boundary (`on_outer`: per point 1 or 0, or empty) with as many layers in
/// all. Roles are right at the corners of the piece's own tetrahedra if it has a halo of
/// `fringe_layers` (MeshView::n_own_tets): then they do not depend on how the mesh is cut, and no
/// message is needed.
[[nodiscard]] std::vector<Role> roles_of(const MeshView& mesh, std::span<const Wall> walls,
                                         std::span<const std::uint8_t> on_outer,
                                         std::int32_t fringe_layers,
                                         std::span<const SymmetryPlane> symmetry = {});

}  // namespace tess::m2m
