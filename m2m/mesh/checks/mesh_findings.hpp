// What validate() looks for, counted over ranges of a mesh. The findings of ranges are joined in
// any order, so PEs that hold a range each check a mesh together and give the messages of one that
// holds all.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace tess::m2m {

struct MeshFindings {
  /// A point with a coordinate that cannot be used.
  struct BadPoint {
    GlobalId point = -1;
    Point at{};
  };
  /// A tetrahedron with a corner that does not exist.
  struct BadCorner {
    GlobalId tet = -1;
    GlobalId corner = 0;
  };
  /// A tetrahedron that is too short for its coordinates, or for any computation.
  struct Collapsed {
    GlobalId tet = -1;
    double longest = 0, largest = 0;
    std::int32_t rounded = 0;  // or tiny
    std::int32_t unused = 0;
  };
  /// A cell that is not of the mesh's dimension.
  struct BadCell {
    GlobalId tet = -1;
    Tet corners{};
  };
  std::int32_t dimension = 3, unused = 0;  // of the mesh
  BadPoint bad_point;                      // the first one of each kind
  BadCorner bad_corner;
  BadCell bad_cell;
  Collapsed collapsed;
  std::uint64_t n_collapsed = 0, n_flat = 0, n_inverted = 0;
  Aabb bounds = collide::no_box<double, 3>();

  /// `first`: the id of the first of them.
  void add_points(GlobalId first, std::span<const Point> points);
  void add_corners(GlobalId first, std::span<const Tet> tets, GlobalId n_points);
  /// Valid corners of one tetrahedron.
  void add_shape(GlobalId tet, const std::array<Point, 4>& corners);
  void join(const MeshFindings& other);

  /// Throws Error (bad_mesh) if a point, a corner or a cell cannot be used.
  void refuse_bad_ids(const std::string& name, GlobalId n_points) const;
  /// Throws Error (bad_mesh) if too many tetrahedra have collapsed, or none has a volume.
  void refuse_bad_shapes(const std::string& name, std::uint64_t n_tets) const;
};

/// For messages: "triangle 5 is (0, 1, 2, 3), but ...". `cell` is not of this dimension.
[[nodiscard]] std::string wrong_cell_text(GlobalId id, const Tet& cell, std::int32_t dimension);

/// Throws Error (bad_mesh) for a mesh without cells or with too many vertices, and for a dimension
/// that is not 1, 2 or 3. `others`: skipped_text().
void refuse_bad_counts(const std::string& name, std::uint64_t n_points, std::uint64_t n_tets,
                       const std::string& others, std::int32_t dimension = 3);

}  // namespace tess::m2m
