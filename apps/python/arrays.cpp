#include "apps/python/arrays.hpp"

namespace tessera_python {
namespace {

using tess::ErrorCode;
using tess::fail;

py::array any_array(const py::handle& given, std::string_view name, std::string_view kinds,
                    std::string_view needed) {
  py::array array = py::array::ensure(given);
  if (!array) {
    PyErr_Clear();
    fail(ErrorCode::bad_value, name, ": no array can be made of this ",
         std::string(py::str(py::type::of(given).attr("__name__"))), "; give ", needed);
  }
  const char kind = array.dtype().kind();
  if (array.size() != 0 && kinds.find(kind) == std::string_view::npos)
    fail(ErrorCode::bad_value, name, ": its dtype is ", std::string(py::str(array.dtype())),
         "; expected ", needed, "; convert it with .astype()");
  return array;
}

void require_shape(const py::array& array, std::string_view name, const Shape& shape,
                   std::string_view layout) {
  if (shape.empty()) return;
  bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
  for (std::size_t k = 0; fits && k < shape.size(); ++k)
    fits = shape[k] < 0 || array.shape(static_cast<py::ssize_t>(k)) == shape[k];
  if (!fits)
    fail(ErrorCode::bad_value, name, ": its shape is ", text_of(array), "; expected ", layout);
}

/// "[5, 2]": where the i-th number stands.
std::string place_of(const py::array& array, py::ssize_t i) {
  std::string place;
  for (py::ssize_t k = array.ndim(); k-- > 0; i /= array.shape(k))
    place = tess::text(k > 0 ? ", " : "[", i % array.shape(k)) + place;
  return place + "]";
}

}  // namespace

std::string text_of(const py::array& array) {
  return py::str(array.attr("shape"));
}

Doubles doubles(const py::handle& given, std::string_view name, const Shape& shape,
                std::string_view layout) {
  const py::array array = any_array(given, name, "fiu", "real numbers");
  require_shape(array, name, shape, layout);
  return Doubles(array);
}

Integers indices(const py::handle& given, std::string_view name, const Shape& shape,
                 std::string_view layout, std::size_t n, std::string_view things) {
  const py::array array = any_array(given, name, "iu", "integers");
  require_shape(array, name, shape, layout);
  Integers out(array);
  const std::int64_t* const first = out.data();
  bool bad = false;
  for (py::ssize_t i = 0; i < out.size(); ++i) bad |= static_cast<std::uint64_t>(first[i]) >= n;
  for (py::ssize_t i = 0; bad && i < out.size(); ++i)
    if (static_cast<std::uint64_t>(first[i]) >= n)
      fail(ErrorCode::out_of_range, name, place_of(out, i), " is ", first[i], ", and there are ", n,
           " ", things, ", numbered from 0 on");
  return out;
}

void require_finite(const Doubles& array, std::string_view name, double most) {
  const double* const first = array.data();
  bool bad = false;
  for (py::ssize_t i = 0; i < array.size(); ++i) bad |= !(std::abs(first[i]) <= most);
  for (py::ssize_t i = 0; bad && i < array.size(); ++i)
    if (!(std::abs(first[i]) <= most))
      fail(ErrorCode::bad_value, name, place_of(array, i), " is ", first[i],
           "; give finite numbers of at most ", most);
}

Doubles Values::room(std::size_t n_rows) const {
  Shape shape{static_cast<py::ssize_t>(n_rows)};
  if (!is_flat) shape.push_back(static_cast<py::ssize_t>(n_components));
  return Doubles(shape);
}

Values values_of(const py::handle& given, std::string_view name, std::size_t n_rows,
                 std::string_view things) {
  const py::array array = any_array(given, name, "fiu", "real numbers");
  const bool is_flat = array.ndim() == 1;
  if ((!is_flat && array.ndim() != 2) || static_cast<std::size_t>(array.shape(0)) != n_rows ||
      (!is_flat && array.shape(1) == 0))
    fail(ErrorCode::bad_value, name, ": its shape is ", text_of(array), "; expected (", n_rows,
         ",) or (", n_rows, ", c), a value or c values for each of the ", things);
  return {Doubles(array), is_flat ? 1 : static_cast<std::size_t>(array.shape(1)), is_flat};
}

void fill_kept(const py::handle& kept, const Values& like, double otherwise, Doubles& to) {
  double* const first = to.mutable_data();
  std::fill_n(first, to.size(), otherwise);
  if (kept.is_none()) return;
  const Values before =
      values_of(kept, "initial", static_cast<std::size_t>(to.shape(0)), "target points");
  if (before.n_components != like.n_components)
    fail(ErrorCode::bad_value, "initial: it has ", before.n_components,
         " components, and the values have ", like.n_components, "; give as many");
  std::copy_n(before.array.data(), to.size(), first);
}

}  // namespace tessera_python
