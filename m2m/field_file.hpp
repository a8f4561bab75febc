// The fields of a mesh file: variables at vertices and in tetrahedra, and their time steps.
//
//     const TetMesh mesh = read_mesh("flow.exo");
//     const FieldFile file("flow.exo");
//     const Field pressure = file.vertex_field(mesh, "p", file.n_steps() - 1);
//
// | format   | at vertices                     | in tetrahedra             | steps              |
// |----------|---------------------------------|---------------------------|--------------------|
// | ExodusII | nodal variables                 | element variables         | those of the file  |
// | gmsh     | $NodeData                       | $ElementData              | of all sections    |
// | VTK      | PointData                       | CellData                  | one                |
//
// ExodusII has scalars only: v_x, v_y and v_z in a row are also read as one field `v` of three
// components, and each under its own name. Only the step that is asked for is read. A NaN in the
// file is a value like any other.
#pragma once

#include "m2m/io/field_reader.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tess::m2m {

class FieldFile {
 public:
  /// Opens the file, and reads the names of the fields and the times. Throws Error (bad_file,
  /// bad_mesh) if it is damaged or of another format, (bad_argument) for a generated mesh, which
  /// has no fields. One thread at a time, as for read_mesh().
  explicit FieldFile(const std::string& path);
  ~FieldFile();
  FieldFile(FieldFile&&) noexcept;
  FieldFile& operator=(FieldFile&&) noexcept;

  [[nodiscard]] const std::vector<FileField>& fields() const noexcept;
  /// The time of each step; they ascend in sound files.
  [[nodiscard]] const std::vector<double>& times() const noexcept;
  [[nodiscard]] std::size_t n_steps() const noexcept { return times().size(); }

  /// The values of a field at the vertices of `mesh`, which read_mesh() returned for the same file.
  /// Throws Error (bad_value) that lists what there is if the file has no such field or step, or no
  /// value for some vertex.
  [[nodiscard]] Field vertex_field(const TetMesh& mesh, std::string_view name,
                                   std::size_t step) const;
  /// Gives the values in tetrahedra likewise. The parts of a split element have its value.
  [[nodiscard]] Field tet_field(const TetMesh& mesh, std::string_view name, std::size_t step) const;

 private:
  [[nodiscard]] Field read(const TetMesh& mesh, std::string_view name, FieldPlace place,
                           std::size_t step) const;
  struct Opened;
  std::unique_ptr<Opened> opened_;
};

}  // namespace tess::m2m
