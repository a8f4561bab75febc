// Pairs of objects that intersect, and queries. The shape of an array says what its rows are.
#include "apps/python/arrays.hpp"
#include "apps/python/module.hpp"
#include "collide/pairs.hpp"
#include "collide/queries.hpp"
#include "collide/sphere.hpp"
#include "collide/tetrahedron.hpp"
#include "collide/triangle.hpp"

#include <cmath>
#include <variant>

namespace tessera_python {
namespace {

using namespace tess::collide;
using tess::ErrorCode;
using tess::fail;

constexpr const char* layouts =
    "(n, 6) of boxes, (n, 3, 3) of triangles, (n, 4, 3) of tetrahedra, (n, 4) of balls, (n, 2, 3) "
    "of "
    "segments or (n, 3) of points";

bool has_rows(const py::array& array, Shape of_row) {
  of_row.insert(of_row.begin(), array.ndim() > 0 ? array.shape(0) : 0);
  return std::equal(array.shape(), array.shape() + array.ndim(), of_row.begin(), of_row.end());
}

/// Calls f with the objects as spans of the type that the shape means.
template <class F>
auto with_objects(const Doubles& array, std::string_view name, const F& f) {
  if (has_rows(array, {6})) return f(rows<Aabb>(array));
  if (has_rows(array, {3, 3})) return f(rows<Triangle>(array));
  if (has_rows(array, {4, 3})) return f(rows<Tetrahedron>(array));
  if (has_rows(array, {4})) return f(rows<Sphere>(array));
  if (has_rows(array, {2, 3})) return f(rows<Segment>(array));
  if (has_rows(array, {3})) return f(rows<Point>(array));
  fail(ErrorCode::bad_value, name, ": its shape is ", text_of(array), "; expected ", layouts);
}

Doubles objects_of(const py::handle& given, std::string_view name) {
  Doubles array = doubles(given, name, {}, layouts);
  with_objects(array, name, [](const auto& /*objects*/) {});
  return array;
}

py::array pairs_of(const py::handle& given, const py::handle& others, bool touching) {
  const Doubles first = objects_of(given, "objects");
  const PairOptions options{.touching = touching ? Touching::counts : Touching::does_not_count};
  std::optional<Doubles> second;
  if (!others.is_none()) {
    second = objects_of(others, "others");
    if (!std::equal(first.shape() + 1, first.shape() + first.ndim(), second->shape() + 1,
                    second->shape() + second->ndim()))
      fail(ErrorCode::bad_value, "others: its shape is ", text_of(*second),
           ", and that of the objects is ", text_of(first), "; give two sets of one kind");
  }
  std::vector<Pair> found =
      with_objects(first, "objects", [&]<class T>(std::span<const T> objects) -> std::vector<Pair> {
        if constexpr (std::is_same_v<T, Point> || std::is_same_v<T, Segment>) {
          fail(ErrorCode::bad_value, "objects: pairs of points or segments are not searched; give ",
               "boxes, triangles, tetrahedra or balls");
        } else {
          const py::gil_scoped_release others_run;
          return second ? pairs(objects, rows<T>(*second), options) : pairs(objects, options);
        }
      });
  const auto n = static_cast<py::ssize_t>(found.size());
  return array_of<std::uint32_t>(std::move(found), {n, 2});
}

/// An Index of objects of a type that is known at run time.
struct AnyIndex {
  std::variant<Index<Aabb>, Index<Triangle>, Index<Tetrahedron>, Index<Sphere>, Index<Segment>,
               Index<Point>>
      of;
};

AnyIndex make_index(const py::handle& given) {
  const Doubles array = objects_of(given, "objects");
  return with_objects(array, "objects", []<class T>(std::span<const T> objects) {
    const py::gil_scoped_release others_run;
    return AnyIndex{Index<T>(objects)};
  });
}

std::size_t size_of(const AnyIndex& index) {
  return std::visit([](const auto& of) { return of.size(); }, index.of);
}

Doubles queries_of(const py::handle& given, std::string_view name) {
  Doubles points = doubles(given, name, {-1, 3}, "(m, 3), x, y, z of each query");
  require_finite(points, name);
  return points;
}

/// Objects of query i: found[begin[i]] to found[begin[i + 1]].
py::tuple within(const AnyIndex& index, const py::handle& given, const py::handle& of_each) {
  const Doubles points = queries_of(given, "points");
  const std::span<const Point> all = rows<Point>(points);
  const Doubles radii = doubles(of_each, "radius", {static_cast<py::ssize_t>(all.size())},
                                "(m,), a radius per point");
  require_finite(radii, "radius");
  std::vector<std::int64_t> begin{0};
  std::vector<std::uint32_t> found;
  {
    const py::gil_scoped_release others_run;
    std::visit(
        [&](const auto& of) {
          for (std::size_t i = 0; i < all.size(); ++i) {
            const std::vector<std::uint32_t> here = of.within(all[i], radii.data()[i]);
            found.insert(found.end(), here.begin(), here.end());
            begin.push_back(static_cast<std::int64_t>(found.size()));
          }
        },
        index.of);
  }
  return py::make_tuple(array_of(std::move(begin)), array_of(std::move(found)));
}

py::tuple nearest(const AnyIndex& index, const py::handle& given, std::int64_t k) {
  if (k < 1) fail(ErrorCode::bad_argument, "k: ", k, " is not a number of objects; give 1 or more");
  const Doubles points = queries_of(given, "points");
  const std::span<const Point> all = rows<Point>(points);
  const std::size_t n = std::min(static_cast<std::size_t>(k), size_of(index));
  std::vector<std::int64_t> objects(all.size() * n);
  std::vector<double> distances(all.size() * n);
  {
    const py::gil_scoped_release others_run;
    std::visit(
        [&](const auto& of) {
          std::size_t at = 0;
          for (const Point& point : all)
            for (const Neighbour& neighbour : of.nearest(point, n)) {
              objects[at] = neighbour.object;
              distances[at++] = std::sqrt(neighbour.distance2);
            }
        },
        index.of);
  }
  const Shape shape{static_cast<py::ssize_t>(all.size()), static_cast<py::ssize_t>(n)};
  return py::make_tuple(array_of<std::int64_t>(std::move(objects), shape),
                        array_of<double>(std::move(distances), shape));
}

py::tuple ray(const AnyIndex& index, const py::handle& origins, const py::handle& directions) {
  const Doubles from = queries_of(origins, "origins"), along = queries_of(directions, "directions");
  if (from.shape(0) != along.shape(0))
    fail(ErrorCode::bad_value, "directions: their shape is ", text_of(along), ", and there are ",
         from.shape(0), " origins; give a direction for each");
  const std::span<const Point> starts = rows<Point>(from), ways = rows<Point>(along);
  std::vector<std::int64_t> objects(starts.size(), -1);
  std::vector<double> at(starts.size(), HUGE_VAL);
  {
    const py::gil_scoped_release others_run;
    std::visit(
        [&]<class T>(const Index<T>& of) {
          if constexpr (requires(const T& object, const Ray& one) { hit(object, one); }) {
            for (std::size_t i = 0; i < starts.size(); ++i)
              if (const auto first = of.first_hit({starts[i], ways[i]})) {
                objects[i] = first->object;
                at[i] = first->at;
              }
          } else {
            fail(ErrorCode::bad_argument,
                 "ray(): no ray hits points or segments; make an Index of boxes, triangles, "
                 "tetrahedra or balls");
          }
        },
        index.of);
  }
  return py::make_tuple(array_of(std::move(objects)), array_of(std::move(at)));
}

}  // namespace

void add_collide(py::module_& module) {
  module.def("pairs", &pairs_of);
  py::class_<AnyIndex>(module, "Index")
      .def(py::init(&make_index))
      .def("__len__", &size_of)
      .def("within", &within)
      .def("nearest", &nearest)
      .def("ray", &ray);
}

}  // namespace tessera_python
