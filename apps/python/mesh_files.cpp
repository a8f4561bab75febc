// Meshes with fields from and to files.
#include "apps/python/mesh.hpp"
#include "apps/python/module.hpp"
#include "m2m/field_file.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/write_exodus.hpp"
#include "m2m/write_vtu.hpp"

#include <pybind11/stl.h>

namespace tessera_python {
namespace {

using namespace tess::m2m;
using tess::ErrorCode;
using tess::fail;

/// What a file holds, before it becomes arrays.
struct FileContent {
  TetMesh mesh;
  std::vector<Field> of_points, of_cells;
  std::vector<double> times;
};

FileContent read(const std::string& path, std::int64_t step) {
  FileContent content{read_mesh(path), {}, {}, {}};
  if (path.starts_with("kuhn:")) return content;
  const FieldFile file(path);
  content.times = file.times();
  if (file.fields().empty()) return content;
  const auto n = static_cast<std::int64_t>(file.n_steps());
  if (step < -n || step >= n)
    fail(ErrorCode::out_of_range, "step ", step, ": ", path, " has ", n,
         " steps, numbered from 0 on, or from -1 back");
  const auto at = static_cast<std::size_t>(step < 0 ? step + n : step);
  for (const FileField& field : file.fields()) {
    if (field.is_part) continue;
    if (field.place == FieldPlace::vertices)
      content.of_points.push_back(file.vertex_field(content.mesh, field.name, at));
    else
      content.of_cells.push_back(file.tet_field(content.mesh, field.name, at));
  }
  return content;
}

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

std::vector<Field> fields_of(const py::dict& given, std::size_t n_rows, std::string_view things) {
  std::vector<Field> fields;
  for (const auto& [key, field] : given) {
    const auto name = std::string(py::str(key));
    const Values values = values_of(field, "field '" + name + "'", n_rows, things);
    fields.push_back({name, values.n_components, {values.span().begin(), values.span().end()}});
  }
  return fields;
}

py::tuple read_file(const std::string& path, std::int64_t step) {
  FileContent content;
  {
    const py::gil_scoped_release others_run;
    content = read(path, step);
  }
  const auto n = static_cast<py::ssize_t>(content.mesh.n_points());
  const auto n_cells = static_cast<py::ssize_t>(content.mesh.n_tets());
  py::object cells = array_of<VertexId>(std::move(content.mesh.tets), {n_cells, 4});
  if (content.mesh.dimension < 3)  // they repeat their last corner
    cells = cells[py::make_tuple(py::ellipsis(), py::slice(0, content.mesh.dimension + 1, 1))];
  return py::make_tuple(array_of<double>(std::move(content.mesh.points), {n, 3}), cells,
                        dict_of(content.of_points), dict_of(content.of_cells), content.times);
}

void write_file(const std::string& path, const py::object& points, const py::object& cells,
                const py::dict& of_points, const py::dict& of_cells) {
  const TetMesh mesh = mesh_of(points, cells, "");
  const std::vector<Field> vertex_fields = fields_of(of_points, mesh.n_points(), "points");
  const std::vector<Field> tet_fields = fields_of(of_cells, mesh.n_tets(), "cells");
  const py::gil_scoped_release others_run;
  (void)validate(mesh);
  if (path.ends_with(".vtu"))
    write_vtu(path, mesh, vertex_fields, tet_fields);
  else if (path.ends_with(".exo") || path.ends_with(".e") || path.ends_with(".ex2"))
    write_exodus(path, mesh, vertex_fields, tet_fields);
  else
    fail(ErrorCode::bad_argument, path,
         ": meshes are written as .vtu (VTK), or .exo, .e or .ex2 "
         "(ExodusII); give a name that ends so");
}

}  // namespace

TetMesh mesh_of(const py::handle& points, const py::handle& cells, const std::string& name) {
  TetMesh mesh;
  const std::string prefix = name.empty() ? "" : name + "_";
  const std::string of_points = prefix + "points", of_cells = prefix + "tets";
  mesh.name = name.empty() ? "mesh" : name;
  const Doubles given = doubles(points, of_points, {-1, 3}, "(n, 3), x, y, z of each point");
  require_finite(given, of_points);
  const std::span<const Point> all = rows<Point>(given);
  if (all.size() > static_cast<std::size_t>(INT32_MAX))
    fail(ErrorCode::out_of_range, of_points, ": there are ", all.size(),
         " points, and a mesh holds at most ", INT32_MAX, "; cut it");
  mesh.points.assign(all.begin(), all.end());
  if (cells.is_none()) return mesh;
  constexpr const char* layout = "(m, 4) of tetrahedra, (m, 3) of triangles or (m, 2) of edges";
  const Integers corners = indices(cells, of_cells, {-1, -1}, layout, all.size(), "points");
  const py::ssize_t n = corners.shape(1);
  if (n < 2 || n > 4)
    fail(ErrorCode::bad_value, of_cells, ": its shape is ", text_of(corners), "; expected ",
         layout);
  mesh.dimension = static_cast<std::int32_t>(n) - 1;
  mesh.tets.resize(static_cast<std::size_t>(corners.shape(0)));
  const std::int64_t* corner = corners.data();
  for (Tet& tet : mesh.tets) {
    for (py::ssize_t k = 0; k < 4; ++k)
      tet[static_cast<std::size_t>(k)] = static_cast<VertexId>(corner[std::min(k, n - 1)]);
    corner += n;
  }
  return mesh;
}

void add_mesh_files(py::module_& module) {
  module.def("read_mesh", &read_file);
  module.def("write_mesh", &write_file);
}

}  // namespace tessera_python
