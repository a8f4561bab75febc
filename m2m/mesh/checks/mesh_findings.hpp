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
  BadPoint bad_point;  // the first one of each kind
  BadCorner bad_corner;
  Collapsed collapsed;
  std::uint64_t n_collapsed = 0, n_flat = 0, n_inverted = 0;
  Aabb bounds = collide::no_box<double, 3>();

  /// `first`: the id of the first of them.
  void add_points(GlobalId first, std::span<const Point> points);
  void add_corners(GlobalId first, std::span<const Tet> tets, GlobalId n_points);
  /// Valid corners of one tetrahedron.
  void add_shape(GlobalId tet, const std::array<Point, 4>& corners);
  void join(const MeshFindings& other);

  /// Throws Error (bad_mesh) if a point or a corner cannot be used.
  void refuse_bad_ids(const std::string& name, GlobalId n_points) const;
  /// Throws Error (bad_mesh) if too many tetrahedra have collapsed, or none has a volume.
  void refuse_bad_shapes(const std::string& name, std::uint64_t n_tets) const;
};

/// Throws Error (bad_mesh) for a mesh without tetrahedra or with too many vertices. `others`:
/// skipped_text().
void refuse_bad_counts(const std::string& name, std::uint64_t n_points, std::uint64_t n_tets,
                       const std::string& others);

}  // namespace tess::m2m
