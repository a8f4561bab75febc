// Between NumPy's arrays and spans: shapes and kinds of numbers are checked before anything is read, and
// arrays of doubles in C order are not copied. The functions need the interpreter's lock.
#pragma once

#include "runtime/core/error.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera_python {

namespace py = pybind11;
using Doubles = py::array_t<double, py::array::c_style>;
using Integers = py::array_t<std::int64_t, py::array::c_style>;
using Shape = std::vector<py::ssize_t>;

/// "(5, 2)".
[[nodiscard]] std::string text_of(const py::array& array);

/// The argument as doubles: itself, if it is that already. In `shape`, -1 is any length; an empty one
/// is not checked. Throws Error
/// with `name` and `layout`, such as "(n, 3), a row per point", for another shape or other things than
/// real numbers.
[[nodiscard]] Doubles doubles(const py::handle& given, std::string_view name, const Shape& shape,
                              std::string_view layout);
/// The argument as integers from 0 to n - 1; an Error names the first other one and its place. `things`:
/// what they number, such as "points".
[[nodiscard]] Integers indices(const py::handle& given, std::string_view name, const Shape& shape,
                               std::string_view layout, std::size_t n, std::string_view things);

/// Throws Error with the place of the first number that is not finite, or larger than `most`.
void require_finite(const Doubles& array, std::string_view name, double most = 1e100);

/// Rows of an array as what has their layout.
template <class T>
[[nodiscard]] std::span<const T> rows(const Doubles& array) {
  static_assert(sizeof(T) % sizeof(double) == 0);
  return {reinterpret_cast<const T*>(array.data()),
          static_cast<std::size_t>(array.size()) * sizeof(double) / sizeof(T)};
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
/// A view of what `owner` holds, which cannot be written to.
template <class T>
[[nodiscard]] py::array_t<T> view_of(std::span<const T> data, const py::handle& owner) {
  py::array_t<T> view(static_cast<py::ssize_t>(data.size()), data.data(), owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

/// Values of points, (n,) or (n, c).
struct Values {
  Doubles array;
  std::size_t n_components = 1;
  bool is_flat = true;

  [[nodiscard]] std::span<const double> span() const { return rows<double>(array); }
  /// Room for as many values per row as this has.
  [[nodiscard]] Doubles room(std::size_t n_rows) const;
};
[[nodiscard]] Values values_of(const py::handle& given, std::string_view name, std::size_t n_rows,
                               std::string_view things);
/// Fills `to` with what target points keep: the values that were given, with as many components, or
/// `otherwise`.
void fill_kept(const py::handle& kept, const Values& like, double otherwise, Doubles& to);

}  // namespace tessera_python
