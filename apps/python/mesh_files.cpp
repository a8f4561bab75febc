// Meshes with fields from and to files.
#include "apps/python/arrays.hpp"
#include "m2m/field_file.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/write_exodus.hpp"
#include "m2m/write_vtu.hpp"

namespace tessera_python {
namespace {

using namespace tess::m2m;
using tess::ErrorCode;
using tess::fail;

py::dict dict_of(std::vector<Field>& fields) {
  py::dict out;
  for (Field& field : fields) {
    const auto n = static_cast<py::ssize_t>(field.n_components);
    const auto n_rows = static_cast<py::ssize_t>(field.values.size()) / n;
    out[py::str(field.name)] =
        array_of<double>(std::move(field.values), n == 1 ? Shape{n_rows} : Shape{n_rows, n});
  }
  return out;
}

std::vector<Field> fields_of(const std::map<std::string, Array<double>>& given) {
  std::vector<Field> fields;
  for (const auto& [name, array] : given) {
    const auto all = rows<double>(array);
    fields.push_back({name,
                      array.ndim() == 1 ? 1 : static_cast<std::size_t>(array.shape(1)),
                      {all.begin(), all.end()}});
  }
  return fields;
}

/// Points, cells, dimension, fields of points, of cells, and the times of the file.
py::tuple read_file(const std::string& path, std::int64_t step) {
  TetMesh mesh;
  std::vector<Field> of_points, of_cells;
  std::vector<double> times;
  const auto read_fields = [&](const FieldFile& file) {
    times = file.times();
    const auto n = static_cast<std::int64_t>(file.n_steps());
    if (!file.fields().empty() && (step < -n || step >= n))
      fail(ErrorCode::out_of_range, "step ", step, ": ", path, " has ", n,
           " steps, numbered from 0 on, or from -1 back");
    const auto at = static_cast<std::size_t>(step < 0 ? step + n : step);
    for (const FileField& field : file.fields())
      if (!field.is_part && field.place == FieldPlace::vertices)
        of_points.push_back(file.vertex_field(mesh, field.name, at));
      else if (!field.is_part)
        of_cells.push_back(file.tet_field(mesh, field.name, at));
  };
  {
    const py::gil_scoped_release others_run;
    mesh = read_mesh(path);
    if (!path.starts_with("kuhn:")) read_fields(FieldFile(path));
  }
  return py::make_tuple(matrix_of<double>(std::move(mesh.points)),
                        matrix_of<VertexId>(std::move(mesh.tets), 4), mesh.dimension,
                        dict_of(of_points), dict_of(of_cells), times);
}

void write_file(const std::string& path, const MeshArrays& arrays,
                const std::map<std::string, Array<double>>& of_points,
                const std::map<std::string, Array<double>>& of_cells) {
  const TetMesh mesh = mesh_of(arrays, "mesh");
  const std::vector<Field> vertex_fields = fields_of(of_points), tet_fields = fields_of(of_cells);
  const py::gil_scoped_release others_run;
  (void)validate(mesh);
  if (path.ends_with(".vtu"))
    write_vtu(path, mesh, vertex_fields, tet_fields);
  else
    write_exodus(path, mesh, vertex_fields, tet_fields);
}

}  // namespace

TetMesh mesh_of(const MeshArrays& arrays, const std::string& name) {
  const auto& [points, cells, dimension] = arrays;
  TetMesh mesh;
  mesh.name = name;
  const auto all = rows<Point>(points);
  mesh.points.assign(all.begin(), all.end());
  if (!cells) return mesh;
  const auto tets = rows<Tet>(*cells);
  mesh.tets.assign(tets.begin(), tets.end());
  mesh.dimension = dimension;
  return mesh;
}

void add_mesh_files(py::module_& module) {
  module.def("read_mesh", &read_file);
  module.def("write_mesh", &write_file);
}

}  // namespace tessera_python
