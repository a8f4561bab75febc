// The normals of the paper's two methods (section 3.1), round after round.
#pragma once

#include "collide/dn_field/build/voxels.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/field.hpp"

#include <array>
#include <span>

namespace tess::dn {

class BlurredNormals {
 public:
  /// Throws Error(bad_argument) for a surface that meets no voxel of the grid.
  BlurredNormals(const Surface& surface, const Grid& grid, Method method, const Blur& blur);

  /// The rounds of the blur, and one that computes the normals from its result.
  [[nodiscard]] int n_rounds() const { return n_blurs_ + 1; }

  /// The layers `first` to `last` − 1 in a round. `field` has all distances, and exact normals.
  void build(int round, Field& field, int first, int last);

 private:
  using Values = std::vector<float>;

  [[nodiscard]] float seed(const SurfaceVoxel& voxel, std::size_t part) const;
  [[nodiscard]] std::span<const SurfaceVoxel> voxels_in(const Grid& grid, int first,
                                                        int last) const;
  void blur(int round, const Grid& grid, int first, int last);
  void set_normals(Field& field, int first, int last) const;
  void set_gradients(Field& field, int first, int last) const;

  Method method_;
  Blur blur_;
  int n_blurs_;
  std::vector<SurfaceVoxel> voxels_;  // in the order of the grid
  // Before and after a round, alternating. Normals: three components; potential: one value.
  std::array<std::vector<Values>, 2> values_;
};

}  // namespace tess::dn
