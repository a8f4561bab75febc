// Norms, integrals and the hash of the values of a distributed mesh. Each part contributes to a
// reduction, so no PE holds more than its parts and, for the hash, an equal range of the values.
// The results are the same bit for bit for any number of parts, PEs and processes. Call these
// functions in a coroutine, while no transfer of the mesh is running.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh/workers/norm_sums.hpp"
#include "m2m/mesh/workers/scatter.hpp"
#include "m2m/rigid_motion.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess::m2m {

/// The norms of one component. m is a quarter of the volume of the tetrahedra at a vertex.
struct FieldNorms {
  ErrorNorms all;              ///< over all vertices
  ErrorNorms found;            ///< over those that are not outside
  Point worst_at{};            ///< where all.worst is
  double integral = 0;         ///< sum of m value
  double l2 = 0;               ///< sqrt(sum m value²)
  double truth_integral = 0;   ///< sum of m truth
  double truth_l2 = 0;         ///< sqrt(sum m truth²)
  double truth_magnitude = 0;  ///< sum of m |truth|
};

/// Compares the values, and the status that the last transfer into the mesh gave, with the formulas
/// `truth`, one per component, at the points where they are now, or where the motions `back` lead
/// them, one after the other. `name`: of the mesh, in errors. Throws Error (bad_argument) if there
/// are not as many formulas as components, or a formula has a mistake, (bad_value) with the vertex
/// where one is not finite. Gives the norms per component.
TaskOf<std::vector<FieldNorms>> measure_norms(DistributedMesh mesh, std::string name,
                                              std::vector<FormulaField> truth,
                                              std::vector<RigidMotion> back = {});

/// The components of a field among those of a mesh.
struct FieldColumns {
  std::uint64_t first = 0, n = 1;
};
/// n fields of one component.
[[nodiscard]] std::vector<FieldColumns> scalar_columns(std::uint64_t n);

/// result_hash() of the fields one after the other, each in the order of the vertices, its rows in
/// that of the components. `n_vertices`: of the whole mesh.
TaskOf<std::uint64_t> hash_values(DistributedMesh mesh, GlobalId n_vertices,
                                  std::vector<FieldColumns> fields);

}  // namespace tess::m2m
