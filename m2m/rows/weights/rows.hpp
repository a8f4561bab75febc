// Sparse rows of weights, in compressed form (CSR). Everything that a transfer computes from a
// source field is linear in the values of the field, and the weights depend on the meshes only. So
// a search computes rows once, and every transfer applies them to any number of fields.
//
// Columns are positions of vertices or tetrahedra in one part of a mesh. The weights of a row are
// added in the order of its columns, so a row gives the same bits wherever it is applied.
#pragma once

#include "m2m/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// `Weight`: double, or Point for rows that give a gradient.
template <class Weight>
struct Rows {
  std::vector<std::uint64_t> begin{0};  ///< n_rows + 1 positions in columns and weights
  std::vector<VertexId> columns{};
  std::vector<Weight> weights{};

  [[nodiscard]] std::size_t n_rows() const noexcept { return begin.size() - 1; }
  [[nodiscard]] std::span<const VertexId> columns_of(std::size_t row) const {
    return std::span(columns).subspan(begin[row], begin[row + 1] - begin[row]);
  }
  [[nodiscard]] std::span<const Weight> weights_of(std::size_t row) const {
    return std::span(weights).subspan(begin[row], begin[row + 1] - begin[row]);
  }
  void add(VertexId column, const Weight& weight) {
    columns.push_back(column);
    weights.push_back(weight);
  }
  void end_row() { begin.push_back(columns.size()); }
  /// Appends a row of others.
  void add_row(const Rows& from, std::size_t row) {
    const auto new_columns = from.columns_of(row);
    const auto new_weights = from.weights_of(row);
    columns.insert(columns.end(), new_columns.begin(), new_columns.end());
    weights.insert(weights.end(), new_weights.begin(), new_weights.end());
    end_row();
  }

  template <class Archive>
  void serialize(Archive& ar) {
    ar(begin, columns, weights);
  }
};

/// out[row][c] = sum of weight × values[column][c]. Both are row-major with `n_components`. A row
/// without columns gives zero.
void apply(const Rows<double>& rows, std::span<const double> values, std::size_t n_components,
           std::span<double> out);

/// The same for gradients: out[row][c] is a Point, the gradient of component c.
void apply(const Rows<Point>& rows, std::span<const double> values, std::size_t n_components,
           std::span<Point> out);

/// The least and the greatest value over the columns of a row.
struct ValueRange {
  double low;
  double high;
  friend bool operator==(const ValueRange&, const ValueRange&) = default;
};
/// Per row and component. A row without columns has the range [+inf, -inf], so ranges of several
/// parts are merged by min and max. A NaN is left out.
void value_ranges(const Rows<double>& rows, std::span<const double> values,
                  std::size_t n_components, std::span<ValueRange> out);

}  // namespace tess::m2m
