// Signed distance fields.
#include "apps/python/arrays.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/read_surface.hpp"

#include <algorithm>

namespace tessera_python {
namespace {

using namespace tess::dn;

/// A field with its origin at `centre`: floats tell points apart there.
struct CentredField {
  Field field;
  Vec3 centre;
};

/// Refuses two triangles that pass their edge in the same direction. Edges of more triangles, as of
/// a wall inside, are left alone, and so is a triangle that is given twice.
void require_agreement(const Surface& surface) {
  if (is_closed(surface)) return;
  std::vector<std::array<std::uint32_t, 3>> sides;  // from, to, triangle
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    if (const auto [a, b, c] = surface.triangles[t]; a != b && b != c && c != a)
      sides.insert(sides.end(), {{a, b, t}, {b, c, t}, {c, a, t}});
  std::ranges::sort(sides);
  const auto n_passes = [&](std::uint32_t from, std::uint32_t to) {
    return std::ranges::upper_bound(sides, std::array{from, to, ~0U}) -
           std::ranges::lower_bound(sides, std::array{from, to, 0U});
  };
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const auto [from, to, t] = sides[i];
    const auto [a, b, other] = sides[i - 1];
    if (a == from && b == to && n_passes(from, to) == 2 && n_passes(to, from) == 0 &&
        !std::ranges::is_permutation(surface.triangles[t], surface.triangles[other]))
      tess::fail(
          tess::ErrorCode::bad_mesh, "triangles ", other, " and ", t,
          " pass their edge in the same direction, so they disagree which side is outside: swap "
          "two corners of the one that is wrong, or give two_sided=True");
  }
}

/// `margin`: a tenth of the longest side if it is not given.
CentredField build(const Array<double>& points, const Array<std::uint32_t>& triangles, int n,
                   std::optional<double> margin, double thickness, bool two_sided) {
  const auto vertices = rows<Vec3>(points);
  const auto corners = rows<std::array<std::uint32_t, 3>>(triangles);
  const Surface given{{vertices.begin(), vertices.end()}, {corners.begin(), corners.end()}};
  const py::gil_scoped_release others_run;
  validate(given);
  Surface surface = two_sided ? given : outward(given);
  if (!two_sided) require_agreement(surface);
  const Bounds box = bounds(surface);
  const Vec3 centre = box.centre(), size = box.size();
  for (Vec3& p : surface.vertices) p = p - centre;
  const Grid grid = grid_around({box.low - centre, box.high - centre}, n,
                                margin.value_or(0.1 * std::max({size.x, size.y, size.z})));
  if (!(grid.cell > 1e-37 && grid.cell * n < 1e37))
    tess::fail(tess::ErrorCode::bad_mesh, "points: the surface has a size of ", norm(size),
               ", and its field cells of ", grid.cell,
               "; both are floats, so scale the points until they are from 1e-37 to 1e37");
  FieldOptions options;
  options.thickness = thickness;
  options.sides = two_sided ? Sides::two : Sides::one;
  return {build_field(surface, grid, options), centre};
}

py::tuple sample(const CentredField& of, const Array<double>& points, std::uint32_t kind) {
  const std::span<const Vec3> all = rows<Vec3>(points);
  std::vector<double> distance, normal;
  {
    const py::gil_scoped_release others_run;
    std::array<std::vector<float>, 7> columns;  // x, y, z; distance; the normal
    for (auto& column : columns) column.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      for (int k = 0; k < 3; ++k)
        columns[static_cast<std::size_t>(k)][i] =
            static_cast<float>(component(all[i] - of.centre, k));
    look_up(of.field, static_cast<LookUp>(kind), {columns[0], columns[1], columns[2]},
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
  py::class_<CentredField>(module, "Field")
      .def(py::init(&build))
      .def("sample", &sample)
      .def("grid", [](const CentredField& of) {
        const Grid& grid = of.field.grid;
        const Vec3 low = grid.box().low + of.centre, high = grid.box().high + of.centre;
        return py::make_tuple(grid.cell, py::tuple(py::cast(grid.n)),
                              py::make_tuple(low.x, low.y, low.z),
                              py::make_tuple(high.x, high.y, high.z));
      });
  module.def("read_surface", &read);
}

}  // namespace tessera_python
