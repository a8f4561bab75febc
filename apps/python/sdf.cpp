// Signed distance fields.
#include "apps/python/arrays.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/read_surface.hpp"

namespace tessera_python {
namespace {

using namespace tess::dn;

/// `margin` is negative where it is not given.
Field build(const Array<double>& points, const Array<std::uint32_t>& triangles, int n,
            double margin, double thickness, bool two_sided) {
  const auto vertices = rows<Vec3>(points);
  const auto corners = rows<std::array<std::uint32_t, 3>>(triangles);
  const Surface given{{vertices.begin(), vertices.end()}, {corners.begin(), corners.end()}};
  const py::gil_scoped_release others_run;
  validate(given);
  const Surface surface = two_sided ? given : outward(given);
  const Bounds box = bounds(surface);
  const Vec3 size = box.size();
  if (margin < 0) margin = 0.1 * std::max({size.x, size.y, size.z});
  FieldOptions options;
  options.thickness = thickness;
  options.sides = two_sided ? Sides::two : Sides::one;
  return build_field(surface, grid_around(box, n, margin), options);
}

py::tuple sample(const Field& field, const Array<double>& points, std::uint32_t kind) {
  const std::span<const Vec3> all = rows<Vec3>(points);
  std::vector<double> distance, normal;
  {
    const py::gil_scoped_release others_run;
    std::array<std::vector<float>, 7> columns;  // x, y, z; distance; the normal
    for (auto& column : columns) column.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      for (int k = 0; k < 3; ++k)
        columns[static_cast<std::size_t>(k)][i] = static_cast<float>(component(all[i], k));
    look_up(field, static_cast<LookUp>(kind), {columns[0], columns[1], columns[2]},
            {columns[3], columns[4], columns[5], columns[6]});
    for (std::size_t i = 0; i < all.size(); ++i) {
      const float d = columns[3][i];
      distance.push_back(d == out_of_reach ? HUGE_VAL : static_cast<double>(d));
      for (std::size_t k = 4; k < 7; ++k) normal.push_back(static_cast<double>(columns[k][i]));
    }
  }
  return py::make_tuple(array_of(std::move(distance)), matrix_of<double>(std::move(normal)));
}

py::tuple read(const std::string& path) {
  Surface surface = read_surface(path);
  return py::make_tuple(matrix_of<double>(std::move(surface.vertices)),
                        matrix_of<std::uint32_t>(std::move(surface.triangles)));
}

}  // namespace

void add_sdf(py::module_& module) {
  py::class_<Field>(module, "Field")
      .def(py::init(&build))
      .def("sample", &sample)
      .def("grid", [](const Field& field) {
        const auto [low, high] = field.grid.box();
        return py::make_tuple(field.grid.cell, py::tuple(py::cast(field.grid.n)),
                              py::make_tuple(low.x, low.y, low.z),
                              py::make_tuple(high.x, high.y, high.z));
      });
  module.def("read_surface", &read);
}

}  // namespace tessera_python
