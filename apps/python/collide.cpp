// Pairs of objects that intersect, and queries. The shape of an array says what its rows are.
#include "apps/python/arrays.hpp"
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

/// Calls f with the objects as spans of the type that the shape of a row means.
template <class F>
auto with_objects(const Array<double>& array, const F& f) {
  const Shape row(array.shape() + 1, array.shape() + array.ndim());
  if (row == Shape{6}) return f(rows<Aabb>(array));
  if (row == Shape{3, 3}) return f(rows<Triangle>(array));
  if (row == Shape{4, 3}) return f(rows<Tetrahedron>(array));
  if (row == Shape{4}) return f(rows<Sphere>(array));
  if (row == Shape{2, 3}) return f(rows<Segment>(array));
  return f(rows<Point>(array));
}

/// `others`: of the same kind, or none.
py::array pairs_of(const Array<double>& given, const std::optional<Array<double>>& others,
                   bool touching) {
  const PairOptions options{.touching = touching ? Touching::counts : Touching::does_not_count};
  return matrix_of<std::uint32_t>(
      with_objects(given,
                   [&]<class T>(std::span<const T> objects) -> std::vector<Pair> {
                     if constexpr (std::is_same_v<T, Point> || std::is_same_v<T, Segment>) {
                       fail(ErrorCode::bad_value,
                            "objects: pairs of points or segments are not searched; give boxes, "
                            "triangles, tetrahedra or balls");
                     } else {
                       const py::gil_scoped_release others_run;
                       return others ? pairs(objects, rows<T>(*others), options)
                                     : pairs(objects, options);
                     }
                   }),
      2);
}

/// An Index of objects of a type that is known at run time.
struct AnyIndex {
  std::variant<Index<Aabb>, Index<Triangle>, Index<Tetrahedron>, Index<Sphere>, Index<Segment>,
               Index<Point>>
      of;
};

AnyIndex make_index(const Array<double>& given) {
  return with_objects(given, []<class T>(std::span<const T> objects) {
    const py::gil_scoped_release others_run;
    return AnyIndex{Index<T>(objects)};
  });
}

std::size_t size_of(const AnyIndex& index) {
  return std::visit([](const auto& of) { return of.size(); }, index.of);
}

template <class Answer>
void ask(const AnyIndex& index, const Answer& answer) {
  const py::gil_scoped_release others_run;
  std::visit(answer, index.of);
}

/// Objects of query i: found[begin[i]] to found[begin[i + 1]].
py::tuple within(const AnyIndex& index, const Array<double>& points, const Array<double>& radii) {
  std::vector<std::int64_t> begin{0};
  std::vector<std::uint32_t> found;
  const auto answer = [&](const auto& of) {
    const double* radius = radii.data();
    for (const Point& point : rows<Point>(points)) {
      const std::vector<std::uint32_t> here = of.within(point, *radius++);
      found.insert(found.end(), here.begin(), here.end());
      begin.push_back(static_cast<std::int64_t>(found.size()));
    }
  };
  ask(index, answer);
  return py::make_tuple(array_of(std::move(begin)), array_of(std::move(found)));
}

py::tuple nearest(const AnyIndex& index, const Array<double>& points, std::size_t k) {
  const std::size_t n = std::min(k, size_of(index));
  std::vector<std::int64_t> objects;
  std::vector<double> distances;
  const auto answer = [&](const auto& of) {
    objects.reserve(rows<Point>(points).size() * n);
    distances.reserve(rows<Point>(points).size() * n);
    for (const Point& point : rows<Point>(points))
      for (const Neighbour& neighbour : of.nearest(point, n)) {
        objects.push_back(neighbour.object);
        distances.push_back(std::sqrt(neighbour.distance2));
      }
  };
  ask(index, answer);
  const Shape shape{points.shape(0), static_cast<py::ssize_t>(n)};
  return py::make_tuple(array_of<std::int64_t>(std::move(objects), shape),
                        array_of<double>(std::move(distances), shape));
}

py::tuple ray(const AnyIndex& index, const Array<double>& origins,
              const Array<double>& directions) {
  std::vector<std::int64_t> objects;
  std::vector<double> at;
  const auto answer = [&]<class T>(const Index<T>& of) {
    if constexpr (requires(const T& object, const Ray& one) { hit(object, one); }) {
      const Point* direction = rows<Point>(directions).data();
      for (const Point& origin : rows<Point>(origins)) {
        const auto first = of.first_hit({origin, *direction++});
        objects.push_back(first ? std::int64_t{first->object} : -1);
        at.push_back(first ? first->at : HUGE_VAL);
      }
    } else {
      fail(
          ErrorCode::bad_argument,
          "ray(): no ray hits points or segments; make an Index of boxes, triangles, tetrahedra or "
          "balls");
    }
  };
  ask(index, answer);
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
