// The plan of a collision: the voxels of each level. It is made on one PE from summaries of what
// was submitted on all PEs, so a collider follows a scene that changes.
//
// Level l has the objects whose longest extent is at most 2 * 8^l voxel sizes, and voxels of 8^l
// sizes. All smaller objects visit its voxels (problem/size_levels.hpp).
#pragma once

#include "collide/collider_options.hpp"
#include "collide/hit.hpp"
#include "collide/parallel/object_list.hpp"
#include "collide/problem/octaves.hpp"
#include "collide/problem/size_levels.hpp"
#include "collide/problem/slim_capsule.hpp"
#include "collide/problem/voxel_grid.hpp"
#include "runtime/run.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tess::collide {

/// What a PE knows of the objects that were submitted to it.
struct Summary {
  std::uint64_t n = 0;
  Aabb bounds = no_box<double, 3>();
  bool has_capsules = false;
  /// Of all capsules; the radius is infinite if one is not known, or much smaller than its box.
  double longest_capsule = 0, largest_radius = 0;
  std::vector<Aabb> sample;
  std::vector<std::uint32_t> sample_models;  ///< per box of the sample
  std::vector<Capsule> capsules;             ///< of the sample, or none
  /// Whose boxes the sample has, one PE after the other.
  struct Sampled {
    std::int32_t pe = 0;
    std::uint32_t n = 0;
  };
  std::vector<Sampled> sampled;
  search::Octaves octaves;
  std::vector<ModelId> models;  ///< at most three different ones

  Summary() = default;
  /// Of the objects on a PE, with so many of their boxes as a sample.
  Summary(const ObjectList& objects, std::int32_t pe, std::size_t n_sampled);
  void add(ModelId model);
  void add(const Aabb& box, const Capsule& capsule);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n, bounds, has_capsules, longest_capsule, largest_radius, sample, sample_models, capsules,
       sampled, octaves, models);
  }
};
/// Joins in any order; in the end the sample is in the order of the PEs.
struct JoinSummaries {
  Summary combine(Summary a, const Summary& b) const;
  Summary finish(Summary all) const;
};

inline constexpr Level most_levels = 32;

/// How long thin objects are searched: with their capsules, in pieces of a length or whole.
struct PlanOfPieces {
  bool used = false;    ///< if not, objects are boxes
  double longest = 0;   ///< on each axis; infinite: objects are whole
  search::Frame frame;  ///< of the capsules in floats
};

struct Plan {
  std::uint64_t step = 0;  ///< of the collider; unique
  Point origin{};
  Point size{};              ///< of the voxels of level 0
  std::uint32_t levels = 0;  ///< a bit per level that has objects
  bool nothing = true;       ///< no pair is possible
  PairRules rules;
  PlanOfPieces pieces;
  SimulatedCosts costs;

  [[nodiscard]] bool has(Level level) const noexcept { return (levels >> level & 1U) != 0; }
  [[nodiscard]] VoxelGrid grid(Level level) const;
  [[nodiscard]] Level level_of(double longest_extent) const noexcept;
  [[nodiscard]] Level lowest() const noexcept { return std::countr_zero(levels); }
  [[nodiscard]] Level highest() const noexcept { return 31 - std::countl_zero(levels); }
};

/// On a simulated machine `n` items of a part take so many nanoseconds each.
inline void charge_each(double nanoseconds, std::size_t n) {
  if (nanoseconds != 0) [[unlikely]]
    charge(Time(std::llround(nanoseconds * static_cast<double>(n))));
}

/// How many boxes each of so many PEs gives to the sample from which a size of zero is chosen.
/// Another size needs none. All PEs wait for the sample, so many PEs give few.
[[nodiscard]] std::size_t n_sampled_per_pe(const Point& size, std::int32_t n_pes) noexcept;

/// For so many PEs. With a size of zero, the size that is expected to cost least; so with the
/// length of pieces. A size that is too small costs time but no memory: objects stand on the level
/// of their size. Throws Error (out_of_range) if a coordinate has no 32-bit cell.
[[nodiscard]] Plan make_plan(const Summary& summary, std::int32_t n_pes,
                             const ColliderOptions& options, std::uint64_t step);

}  // namespace tess::collide
