#include "m2m/rows/weights/rows.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <limits>

namespace tess::m2m {
namespace {

void check_sizes(std::size_t n_rows, std::size_t n_components, std::size_t n_out) {
  TESS_CHECK(n_out == n_rows * n_components, "expected ", n_rows, " rows of ", n_components,
             " components, got room for ", n_out, " numbers");
}

}  // namespace

void apply(const Rows<double>& rows, std::span<const double> values, std::size_t n_components,
           std::span<double> out) {
  check_sizes(rows.n_rows(), n_components, out.size());
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t row = 0; row < rows.n_rows(); ++row) {
    double* const to = out.data() + row * n_components;
    for (std::uint64_t k = rows.begin[row]; k < rows.begin[row + 1]; ++k) {
      const double* const from =
          values.data() + static_cast<std::size_t>(rows.columns[k]) * n_components;
      for (std::size_t c = 0; c < n_components; ++c) to[c] += rows.weights[k] * from[c];
    }
  }
}

void apply(const Rows<Point>& rows, std::span<const double> values, std::size_t n_components,
           std::span<Point> out) {
  check_sizes(rows.n_rows(), n_components, out.size());
  std::fill(out.begin(), out.end(), Point{});
  for (std::size_t row = 0; row < rows.n_rows(); ++row) {
    Point* const to = out.data() + row * n_components;
    for (std::uint64_t k = rows.begin[row]; k < rows.begin[row + 1]; ++k) {
      const double* const from =
          values.data() + static_cast<std::size_t>(rows.columns[k]) * n_components;
      for (std::size_t c = 0; c < n_components; ++c)
        for (std::size_t axis = 0; axis < 3; ++axis) to[c][axis] += rows.weights[k][axis] * from[c];
    }
  }
}

void value_ranges(const Rows<double>& rows, std::span<const double> values,
                  std::size_t n_components, std::span<ValueRange> out) {
  check_sizes(rows.n_rows(), n_components, out.size());
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::fill(out.begin(), out.end(), ValueRange{inf, -inf});
  for (std::size_t row = 0; row < rows.n_rows(); ++row) {
    for (const VertexId column : rows.columns_of(row)) {
      for (std::size_t c = 0; c < n_components; ++c) {
        const double value = values[static_cast<std::size_t>(column) * n_components + c];
        ValueRange& range = out[row * n_components + c];
        if (value < range.low) range.low = value;
        if (value > range.high) range.high = value;
      }
    }
  }
}

}  // namespace tess::m2m
