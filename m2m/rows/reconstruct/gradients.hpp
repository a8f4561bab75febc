// Recovered gradients of a field given at the vertices of a part of a mesh, as rows of weights: the
// rows depend on the mesh only, and are applied to any number of fields (rows.hpp).
//
// The patch of a vertex are the vertices that share a tetrahedron with it. If these do not
// determine a quadratic polynomial (corners and edges of a domain), the patch grows by their
// neighbours; if these do not, either, the fit falls back (gradient_fit.hpp). So the rows of a
// vertex are those of the whole mesh if the part holds all tetrahedra within two layers around the
// vertex. Sums are in the order of global ids: the same bits in every decomposition.
#pragma once

#include "m2m/mesh_view.hpp"
#include "m2m/rows/weights/rows.hpp"

#include <span>

namespace tess::m2m {

/// One row per entry of `vertices`; its columns are the patch, and the vertex itself. `ids`: the
/// global ids of mesh.points; empty if positions are global ids. A vertex without neighbours gets
/// an empty row: the gradient zero. Takes about 5 µs per vertex.
[[nodiscard]] Rows<Point> gradient_rows(MeshView mesh, std::span<const GlobalId> ids,
                                        std::span<const VertexId> vertices);
/// The same for all vertices of the mesh.
[[nodiscard]] Rows<Point> gradient_rows(MeshView mesh);

/// Gradients of a field with a value per tetrahedron, at the centroids: a linear fit to the
/// tetrahedra that share a vertex. Exact for linear fields. One row per entry of `cells`; columns
/// are tetrahedra. `ids`: global ids of mesh.tets; may be empty. The part must hold one layer
/// around.
[[nodiscard]] Rows<Point> cell_gradient_rows(MeshView mesh, std::span<const GlobalId> ids,
                                             std::span<const std::int32_t> cells);
[[nodiscard]] Rows<Point> cell_gradient_rows(MeshView mesh);

}  // namespace tess::m2m
