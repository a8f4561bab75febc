// The exact construction: the distance is that to the nearest feature of the mesh, the sign comes
// from the winding number. Meshes may have holes, flipped triangles and parts that are inside out
// (orientation.hpp), and may be far denser or coarser than the grid. Blocks of 4³ voxels traverse a
// tree of the triangles together; blocks beyond the thickness are skipped.
//
// ExactBuilder serves parallel construction: it fills any layers of a field on any thread, and the
// field does not depend on how the layers were split. build_exact fills them one after the other.
#pragma once

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/field.hpp"

#include <functional>
#include <memory>
#include <span>

namespace tess::dn {

struct ExactOptions {
  Sides sides = Sides::one;
  Content content = Content::distance_and_normal;
  /// In the object's units. Distances are cut off here, which saves most of the time.
  double thickness = HUGE_VAL;
  /// Called with the fraction done after every few layers; may be empty.
  std::function<void(double)> progress;
};

/// The layers `first` to `last` − 1 of a field, to be filled.
struct Slab {
  int first = 0, last = 0;
  std::span<float> distance;        ///< (last − first) × n[1] × n[0], x fastest
  std::span<std::uint32_t> normal;  ///< likewise; empty if no normals are wanted
};

/// The result of filled layers, apart from the field itself.
struct BuiltSlab {
  int first = 0, last = 0;
  double furthest = 0;  ///< the greatest |distance|
  float jump = 0;       ///< Field::jump within the layers
};

/// The layers of `field` as a slab.
[[nodiscard]] Slab slab_of(Field& field, int first, int last);

class Inside;
class OutwardSurface;

class ExactBuilder {
 public:
  /// Does not refer to `surface` afterwards. Throws Error(bad_mesh) where validate() does,
  /// Error(bad_argument) for a thickness below two cells, a grid without voxels or cells without
  /// size, and Error(environment) for a field that does not fit into memory.
  ExactBuilder(const Surface& surface, const Grid& grid, ExactOptions options);
  ~ExactBuilder();
  ExactBuilder(const ExactBuilder&) = delete;
  ExactBuilder& operator=(const ExactBuilder&) = delete;

  /// A field with room for all layers.
  [[nodiscard]] Field empty_field() const;

  /// Fills the layers of `slab`; progress gets the fraction of the slab. Distances are rounded to
  /// float. Any thread, different slabs at once. Split at multiples of 4 layers: blocks that
  /// are cut are computed twice.
  [[nodiscard]] BuiltSlab build(const Slab& slab) const;

  /// Reduces the field's thickness to the greatest distance in it, and sets its jump. `slabs`: all
  /// layers, in any order; some slabs may be empty.
  void finish(Field& field, std::span<const BuiltSlab> slabs) const;

 private:
  struct Shelf;  // up to four layers
  /// `outward`: of `surface`; null for two-sided fields.
  ExactBuilder(const Surface& surface, const std::unique_ptr<const OutwardSurface>& outward,
               const Grid& grid, ExactOptions options);
  void fill_block(int i, int j, const Shelf& shelf) const;
  double build_shelf(const Slab& slab, int first, int last) const;

  Grid grid_;
  std::uint64_t surface_;  // fingerprint
  ExactOptions options_;
  Bvh tree_;
  std::unique_ptr<const Inside> inside_;  // null for two-sided fields
};

/// Builds the field of `surface` on `grid`. Normals point along the gradient of the distance;
/// within a thousandth of a cell from the surface they are those of the nearest triangle. Throws as
/// ExactBuilder does.
[[nodiscard]] Field build_exact(const Surface& surface, const Grid& grid,
                                const ExactOptions& options = {});

}  // namespace tess::dn
