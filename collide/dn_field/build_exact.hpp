// The exact construction: signed distance by the closest feature of the mesh, sign by the winding
// number, so that meshes with holes and flipped triangles work, and those turned inside out
// (outward.hpp). The surface may be far denser or
// coarser than the grid. Blocks of 4³ voxels walk a tree of the triangles together; blocks further
// than the thickness are not asked for.
//
// ExactBuilder is the seam for building in parallel: made once, it fills any layers of a field on
// any thread, and the field does not depend on how its layers were split. build_exact does them one
// after the other.
#pragma once

#include "collide/dn_field/build/sign.hpp"
#include "collide/dn_field/field.hpp"
#include "collide/dn_field/surface.hpp"

#include <functional>
#include <span>

namespace tess::dn {

struct ExactOptions {
  Sides sides = Sides::one;
  Content content = Content::distance_and_normal;
  double thickness = HUGE_VAL;  ///< in the object's units; distances are cut off here, which saves
                                ///< most of the time
  std::function<void(double)>
      progress;  ///< called with the fraction done, after every few layers; may be empty
};

/// The layers `first` to `last` − 1 of a field, to be filled.
struct Slab {
  int first = 0, last = 0;
  std::span<float> distance;        ///< (last − first) × n[1] × n[0], x fastest
  std::span<std::uint32_t> normal;  ///< likewise; empty: not asked for
};

/// What was found in layers that are filled.
struct BuiltSlab {
  int first = 0, last = 0;
  double furthest = 0;  ///< the greatest |distance|
  float jump = 0;       ///< Field::jump within the layers
};

/// The layers of `field` as a slab.
[[nodiscard]] Slab slab_of(Field& field, int first, int last);

class ExactBuilder {
 public:
  /// Copies what it needs of `surface`. Throws Error(bad_mesh) where validate() does,
  /// Error(bad_argument) for a thickness below two cells, a grid without voxels or cells without
  /// size, and Error(environment) for a field that memory cannot hold.
  ExactBuilder(const Surface& surface, const Grid& grid, ExactOptions options);
  ExactBuilder(const ExactBuilder&) = delete;  // its parts know one another by address
  ExactBuilder& operator=(const ExactBuilder&) = delete;

  /// A field with room for all layers, thickness as asked for.
  [[nodiscard]] Field empty_field() const;

  /// Fills the layers of `slab`; progress is called with its part of them. Errors of distance:
  /// rounding to float. Any thread, different slabs at once. Best split at multiples of 4 layers:
  /// others are done twice.
  [[nodiscard]] BuiltSlab build(const Slab& slab) const;

  /// Cuts the field's thickness to the greatest distance that was found, and sets its jump.
  /// `slabs`: all layers, in any order; some slabs may be empty.
  void finish(Field& field, std::span<const BuiltSlab> slabs) const;

 private:
  struct Shelf;  // up to four layers
  /// `outward`: of `surface`, for one-sided fields.
  ExactBuilder(const Surface& surface, const std::optional<OutwardSurface>& outward,
               const Grid& grid, ExactOptions options);
  void fill_block(int i, int j, const Shelf& shelf) const;
  double build_shelf(const Slab& slab, int first, int last) const;

  Grid grid_;
  std::uint64_t surface_;  // fingerprint
  ExactOptions options_;
  Bvh tree_;
  std::optional<Inside> inside_;
};

/// Builds the field of `surface` on `grid`. Normals point along the gradient of the distance, and
/// are those of the closest triangle within a thousandth of a cell from the surface. Throws as
/// ExactBuilder does.
[[nodiscard]] Field build_exact(const Surface& surface, const Grid& grid,
                                const ExactOptions& options = {});

}  // namespace tess::dn
