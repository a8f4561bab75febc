#include "apps/fsi/strip.hpp"

namespace fsi {

Strip::Strip(std::int32_t n, std::int32_t n_pieces, std::int32_t piece) : n_(n) {
  const auto row_at = [&](std::int32_t k) {
    return static_cast<std::int32_t>(std::int64_t{k} * (n + 1) / n_pieces);
  };
  first_row_ = row_at(piece);
  is_first_ = piece == 0;
  const std::int32_t n_rows = row_at(piece + 1) - first_row_;
  const std::int32_t n_held = n_rows + (piece + 1 < n_pieces ? 1 : 0);
  n_owned_ = static_cast<std::size_t>(n_rows) * side();
  for (std::int32_t row = first_row_; row < first_row_ + n_held; ++row)
    for (std::int32_t column = 0; column <= n; ++column) {
      points_.push_back({double(column) / n, double(row) / n, 0});
      point_ids_.push_back(std::int64_t{row} * (n + 1) + column);
    }
  for (std::int32_t row = 0; row + 1 < n_held; ++row)
    for (std::int32_t column = 0; column < n; ++column) {
      const std::int32_t a = row * (n + 1) + column, b = a + 1, c = a + n + 1, d = c + 1;
      for (const tess::m2m::Tet& triangle : {tess::m2m::Tet{a, b, d, d}, {a, d, c, c}}) {
        triangle_ids_.push_back(2 * point_ids_[static_cast<std::size_t>(a)] +
                                (triangle[1] == d ? 1 : 0));
        triangles_.push_back(triangle);
      }
    }
}

int Strip::n_edges_at(std::size_t point) const {
  const auto column = static_cast<std::int32_t>(point % side());
  const auto row = first_row_ + static_cast<std::int32_t>(point / side());
  return (column == 0 || column == n_ ? 1 : 0) + (row == 0 || row == n_ ? 1 : 0);
}

bool Strip::is_held(std::size_t point) const {
  return n_edges_at(point) > 0;
}

double Strip::area(std::size_t point) const {
  return 1.0 / (double(n_) * n_ * (1 << n_edges_at(point)));
}

}  // namespace fsi
