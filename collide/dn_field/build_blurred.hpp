// The paper's two constructions (section 3.1). Normals method: the surface's normals, rasterised
// and blurred, the voxels on the surface getting their first value back after every round.
// Potential method: occupancy, blurred in the same way, and the normal as its gradient. Near the
// object normals are perpendicular to the surface, further away they follow its overall shape.
//
// Where we differ: distances are the exact ones, not counted in voxels. The potential is blurred
// once more without restoring anything, else the steps of the voxels show in its gradient; and on
// the surface itself, where it has its ridge and no gradient, the direction is that to the closest
// point.
//
// BlurredBuilder is the seam for building in parallel: distances first, then round after round,
// each over any split of the layers. build_blurred does all in order.
#pragma once

#include "collide/dn_field/build/plan.hpp"
#include "collide/dn_field/build/voxels.hpp"
#include "collide/dn_field/build_exact.hpp"

#include <array>

namespace tess::dn {

/// While a field is built: the field, three components before and after a round, and some more.
inline constexpr double bytes_per_voxel_blurring = 36;

struct BlurredOptions {
  Method method = Method::normals;       ///< normals or potential
  Sides sides = Sides::one;              ///< the normals method serves one side alone
  double thickness = HUGE_VAL;           ///< distances and normals are cut off here
  Blur blur;                             ///< rounds 0: choose_blur
  std::function<void(double)> progress;  ///< called with the fraction done; may be empty
};

class BlurredBuilder {
 public:
  /// Copies what it needs of `surface`; `options.progress` is not called. Throws as ExactBuilder
  /// does, and Error(bad_argument) for a blur out of range, a surface that meets no voxel of the
  /// grid, and a two-sided field by normals.
  BlurredBuilder(const Surface& surface, const Grid& grid, const BlurredOptions& options);

  /// The distances of the layers `first` to `last` − 1. Any thread, different layers at once; the
  /// field does not depend on how they are split. Best split at multiples of 4 layers.
  void build_distances(int first, int last);

  /// Rounds that follow: of the blur, and one that makes normals of what came out.
  [[nodiscard]] int n_rounds() const { return n_blurs_ + 1; }

  /// The same layers, or others, in round `round`, from 0. All layers of a round must be built
  /// before the next begins, and all distances before the first. Throws Error(bad_argument) from
  /// layer 0 of round 0 for an object of near-zero thickness by normals: one where more than a
  /// tenth of the surface's voxels have nothing inside behind them.
  void build_round(int round, int first, int last);

  /// The field, once all is built; then this builder is empty.
  [[nodiscard]] Field finish();

  BlurredBuilder(const BlurredBuilder&) = delete;
  BlurredBuilder& operator=(const BlurredBuilder&) = delete;

 private:
  using Values = std::vector<float>;

  /// `surface`: its triangles' normals are what is blurred.
  BlurredBuilder(Surface surface, const BlurredOptions& options, const Grid& grid);
  [[nodiscard]] float seed(const SurfaceVoxel& voxel, std::size_t part) const;
  [[nodiscard]] std::span<const SurfaceVoxel> voxels_in(int first, int last) const;
  void require_body() const;
  void blur(int round, int first, int last);
  void set_normals(int first, int last);
  void set_gradients(int first, int last);

  Surface surface_;
  Blur blur_;
  int n_blurs_;
  ExactBuilder exact_;
  Field field_;
  std::vector<BuiltSlab> slabs_;      // by their first layer
  std::vector<SurfaceVoxel> voxels_;  // in the order of the grid
  // By turns before and after a round. Normals: three components; potential: one value.
  std::array<std::vector<Values>, 2> values_;
};

/// Builds the field of `surface` on `grid`. On a sphere of 14 cells radius normals are within
/// 6° of the exact ones (mean 1°), by the potential within 22° (mean 3°). Throws as BlurredBuilder
/// does.
[[nodiscard]] Field build_blurred(const Surface& surface, const Grid& grid,
                                  const BlurredOptions& options);

}  // namespace tess::dn
