// A mesh of a file, or a generated one, of which each PE reads its own range of points and
// tetrahedra. Every PE opens the file, and checks its header.
#pragma once

#include "m2m/mesh.hpp"

#include <memory>
#include <span>
#include <string>

namespace tess::m2m {

class MeshRanges {
 public:
  MeshRanges() = default;
  MeshRanges(const MeshRanges&) = delete;
  MeshRanges& operator=(const MeshRanges&) = delete;
  virtual ~MeshRanges() = default;

  GlobalId n_points = 0, n_tets = 0;
  std::string skipped{};  ///< as skipped_text()

  /// Read the ranges that begin with id `first`. Throw Error (bad_file, bad_mesh).
  virtual void points(GlobalId first, std::span<Point> out) = 0;
  virtual void tets(GlobalId first, std::span<Tet> out) = 0;
};

/// How much of a file open_ranges() reads. One PE checks what concerns the whole file.
enum class RangeCheck { header, all };

/// `name` as for read_mesh(). Null if the file cannot be read in ranges: then read_mesh() decides
/// about it. These can be: kuhn:N; ExodusII files (NetCDF-3) of TET4 only; binary gmsh files of
/// version 4.1 whose solids are tet4 and whose node tags are consecutive.
[[nodiscard]] std::unique_ptr<MeshRanges> open_ranges(const std::string& name,
                                                      RangeCheck check = RangeCheck::header);

}  // namespace tess::m2m
