// A mesh from the arrays of an argument pair.
#pragma once

#include "apps/python/arrays.hpp"
#include "m2m/mesh.hpp"

namespace tessera_python {

/// The mesh of NAME_points, (n, 3), and NAME_tets: (m, 4), (m, 3) of triangles, (m, 2) of edges, or
/// None of a cloud. Throws Error with the first place that cannot be used; validate() checks the rest.
[[nodiscard]] tess::m2m::TetMesh mesh_of(const py::handle& points, const py::handle& cells,
                                         const std::string& name);

}  // namespace tessera_python
