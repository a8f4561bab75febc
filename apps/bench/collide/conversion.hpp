// Ways to turn a coordinate into the index of its voxel, the inner loop of gridding (Lawlor and Kalé
// 2002, appendix A), side by side: speed, and whether the index is right.
#pragma once

#include "collide/box.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace bench {

/// Voxels of one edge; the index of x is floor((x - origin) / size).
struct VoxelAxis {
  double origin;
  double size;  ///< a power of two, as the paper's constant needs
};

/// What a form does with a coordinate that has no 32-bit index.
enum class OutOfRange { refuses, clamps, wraps };

struct Conversion {
  std::string_view name;
  std::string_view meaning;
  OutOfRange out_of_range;
  /// Writes six indices per box, lo before hi. False if a coordinate has none; the forms that wrap
  /// do not notice. The number of boxes is a multiple of 4.
  bool (*run)(const VoxelAxis& axis, std::span<const tess::collide::Aabb> boxes,
              std::int32_t* index);
};
/// Those that this build's instruction set allows.
[[nodiscard]] std::span<const Conversion> conversions();

/// Coordinates of one kind, and how many of them get a wrong index.
struct ConversionErrors {
  std::uint64_t n = 0;
  std::uint64_t n_wrong = 0;
};
/// Multiples of the voxel's edge, of both signs.
[[nodiscard]] ConversionErrors errors_on_faces(const Conversion& conversion);
/// Coordinates inside voxels of negative index.
[[nodiscard]] ConversionErrors errors_of_negatives(const Conversion& conversion);
/// Coordinates beyond the indices of 32 bits: each is to be refused, or clamped to the nearest
/// index.
[[nodiscard]] ConversionErrors errors_out_of_range(const Conversion& conversion);

}  // namespace bench
