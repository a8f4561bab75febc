// A distance/normal field: for each voxel of a grid the signed distance to the surface (negative
// inside) and the unit normal (paper, section 3). Built once, then read-only and shared
// by all PEs of a process. A scene that needs only distances stores no normals.
#pragma once

#include "collide/dn_field/grid.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace tess::dn {

enum class Method : std::uint32_t { exact, normals, potential };
inline constexpr const char* method_names[] = {"exact", "normals", "potential"};
[[nodiscard]] constexpr const char* name_of(Method method) {
  return method_names[static_cast<std::size_t>(method)];
}

/// one: distances are negative inside. two: an open surface (a shell, a plate), met from either
/// side.
enum class Sides : std::uint32_t { one, two };

/// What a field stores.
enum class Content : std::uint32_t { distance, distance_and_normal };

struct Planes;

/// The distance that a field stores where no surface is within its thickness: a little more, so that
/// a rule that reaches as far as the field does not act there, in an object of any scale.
[[nodiscard]] inline float cut_off(double thickness) {
  return static_cast<float>(thickness * (1 + 0x1p-21));
}

struct Field {
  Grid grid;
  Method method = Method::exact;
  Sides sides = Sides::one;
  double thickness = 0;               ///< |distance| is known up to here; beyond, it is cut_off()
  std::vector<float> distance;        ///< grid.size(); empty if compressed
  std::vector<std::uint32_t> normal;  ///< grid.size() codes of normal_code.hpp, or empty

  /// Upper bound of the distance difference between adjacent voxels (26 neighbours); +inf if not
  /// computed. Culling needs it to skip distant particles for several steps.
  float jump = HUGE_VALF;

  std::uint64_t surface = 0;  ///< fingerprint() of the surface it was built from; 0: of none
  std::shared_ptr<const Planes> planes{};  ///< of a compressed field; null for others

  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] Content content() const;
};

/// Field::jump of a field; for exact distances it is at most a voxel's diagonal.
[[nodiscard]] float greatest_jump(const Field& field);

}  // namespace tess::dn
