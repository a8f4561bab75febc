// A distance/normal field: for each voxel of a grid the signed distance to the surface (negative
// inside) and the unit normal. Built once, then read-only and shared by all PEs of a process.
// Distances and normals lie in arrays of their own, so that a scene that asks for distances alone
// stores no normals.
#pragma once

#include "collide/dn_field/grid.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::dn {

enum class Method : std::uint32_t { exact, normals, potential };

/// Whether distances are negative behind the surface, or count from either side (thin shells,
/// plates).
enum class Sides : std::uint32_t { one, two };

/// What a field stores.
enum class Content : std::uint32_t { distance, distance_and_normal };

struct Field {
  Grid grid;
  Method method = Method::exact;
  Sides sides = Sides::one;
  double thickness = 0;  ///< |distance| is cut off here; a lower bound of the true distance beyond
  std::vector<float> distance;        ///< grid.size()
  std::vector<std::uint32_t> normal;  ///< grid.size() codes of normal_code.hpp, or empty

  /// By no more than this do distances of voxels that touch differ, at faces, edges or corners;
  /// infinite where nobody looked. It lets the step loop leave distant particles alone for a while.
  float jump = HUGE_VALF;

  std::uint64_t surface = 0;  ///< fingerprint() of the surface it was built from; 0: of none

  [[nodiscard]] std::size_t bytes() const {
    return distance.size() * sizeof(float) + normal.size() * sizeof(std::uint32_t);
  }
};

/// Field::jump of these distances; where they are the surface's, a voxel's diagonal at most.
[[nodiscard]] float greatest_jump(const Field& field);
/// The same within some layers of a field on `grid`: `distance` holds n[1] × n[0] of each.
[[nodiscard]] float greatest_jump(const Grid& grid, std::span<const float> distance);

}  // namespace tess::dn
