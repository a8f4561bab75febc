// Between NumPy's arrays and spans. tessera/_check.py has checked what comes in: shapes, kinds of numbers,
// finite coordinates and indices in range. Arrays of doubles in C order are not copied.
#pragma once

#include "m2m/mesh.hpp"
#include "runtime/core/error.hpp"

#include <memory>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <span>
#include <string>
#include <vector>

namespace tessera_python {

namespace py = pybind11;
template <class T>
using Array = py::array_t<T, py::array::c_style>;
using Shape = std::vector<py::ssize_t>;

/// An array as a list of what has the layout of its rows.
template <class Row, class T>
[[nodiscard]] std::span<const Row> rows(const Array<T>& array) {
  static_assert(sizeof(Row) % sizeof(T) == 0);
  return {reinterpret_cast<const Row*>(array.data()),
          static_cast<std::size_t>(array.size()) * sizeof(T) / sizeof(Row)};
}

/// An array that takes over the memory of a list. T: what the list's elements are made of.
template <class T, class Element>
[[nodiscard]] py::array_t<T> array_of(std::vector<Element> list, Shape shape) {
  auto kept = std::make_unique<std::vector<Element>>(std::move(list));
  const T* const data = reinterpret_cast<const T*>(kept->data());
  const py::capsule owner(kept.release(),
                          [](void* p) { delete static_cast<std::vector<Element>*>(p); });
  return py::array_t<T>(std::move(shape), data, owner);
}
template <class T>
[[nodiscard]] py::array_t<T> array_of(std::vector<T> list) {
  const auto n = static_cast<py::ssize_t>(list.size());
  return array_of<T, T>(std::move(list), {n});
}
/// A list of rows of `n` numbers T.
template <class T, class Element>
[[nodiscard]] py::array_t<T> matrix_of(std::vector<Element> list, py::ssize_t n = 3) {
  const auto size = static_cast<py::ssize_t>(list.size() * sizeof(Element) / sizeof(T)) / n;
  return array_of<T>(std::move(list), {size, n});
}

/// Points, cells (m, 4) or none of a cloud, and the dimension of the cells, which repeat their last
/// corner if it is below 3.
using MeshArrays = std::tuple<Array<double>, std::optional<Array<std::int32_t>>, std::int32_t>;
[[nodiscard]] tess::m2m::TetMesh mesh_of(const MeshArrays& arrays, const std::string& name);

}  // namespace tessera_python
