// What a part contributes to the norms of its mesh (field_norms.hpp). Each tetrahedron is one
// part's own, so a sum over the mesh is the sum over own tetrahedra: of a quarter of the volume,
// times the sum over the corners; over triangles, of a third of the area. Such a term is rounded where it is computed, and depends on no
// part; the terms add up exactly. So the bits of the result do not depend on the partition.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh_view.hpp"
#include "m2m/rigid_motion.hpp"
#include "m2m/status.hpp"
#include "runtime/core/exact_sum.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tess::m2m {

/// What the values of a mesh are compared with.
struct NormsRequest {
  std::string mesh{};                 ///< its name, in errors
  std::vector<FormulaField> truth{};  ///< per component
  std::vector<RigidMotion>
      back{};  ///< of the points, one after the other, to where the truth holds
};

/// The largest of some errors. A NaN is larger than all numbers; of equal ones the first vertex
/// counts.
struct LargestError {
  double error = 0;
  GlobalId vertex = -1;  ///< -1: no vertex
  Point at{};
  void add(const LargestError& other);
};

/// Of some vertices: sums of m e² and m truth².
struct SquareSums {
  ExactSum error, truth;
  void add(const SquareSums& other);
};

/// The sums of one component. `all` and `found` are sums over a tetrahedron's corners; where all
/// four are found they are equal, and only `same` has them.
struct ComponentSums {
  SquareSums same, all, found;
  ExactSum value, value_squared, truth,
      truth_magnitude;                  ///< each weighted with m, over all vertices
  ExactSum plain_found, plain_outside;  ///< e² per vertex
  LargestError worst, worst_found;
  bool underflows = false;  ///< a term that is not zero became zero or lost digits
  void add(const ComponentSums& other);
};

/// A truth that is not finite; of several the first component's first vertex.
struct NotFinite {
  std::int64_t component = -1;  ///< -1: none
  GlobalId vertex = 0;
  double value = 0;
  Point at{};
  void keep_first(const NotFinite& other);
};

struct NormSums {
  std::vector<ComponentSums> components;
  std::uint64_t n_vertices = 0, n_found = 0;
  NotFinite refused{};
};
struct JoinNorms {
  NormSums operator()(NormSums a, const NormSums& b) const;
};

/// The sums of one part. `values`: of all its points, row-major; `status`: of the same points.
[[nodiscard]] NormSums norm_sums(const MeshView& part, std::span<const double> values,
                                 std::span<const Status> status, const NormsRequest& request);

}  // namespace tess::m2m
