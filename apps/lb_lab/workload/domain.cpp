#include "apps/lb_lab/workload/domain.hpp"

#include "runtime/core/error.hpp"

#include <limits>

namespace lb_lab {
namespace {

std::int32_t first_of(std::int32_t part, std::int32_t n_parts, std::int32_t n_cells) {
  return static_cast<std::int32_t>(std::int64_t{n_cells} * part / n_parts);
}

}  // namespace

Block Domain::block(std::int32_t element) const {
  const std::int32_t column = element % columns, row = element / columns;
  const Cell first{first_of(column, columns, width), first_of(row, rows, height)};
  return {first, first_of(column + 1, columns, width) - first.x,
          first_of(row + 1, rows, height) - first.y};
}

std::int32_t Domain::neighbour(std::int32_t element, Side side) const {
  const std::int32_t column = element % columns, row = element / columns;
  switch (side) {
    case Side::west:
      return column > 0 ? element - 1 : -1;
    case Side::east:
      return column + 1 < columns ? element + 1 : -1;
    case Side::south:
      return row > 0 ? element - columns : -1;
    case Side::north:
      break;
  }
  return row + 1 < rows ? element + columns : -1;
}

Domain line_of(std::int32_t n_cells) {
  return {n_cells, 1, n_cells, 1};
}

Domain plane_of(std::int32_t n_blocks) {
  std::int32_t rows = 1;
  for (std::int32_t r = 1; r * r <= n_blocks; ++r)
    if (n_blocks % r == 0) rows = r;
  return {2 * (n_blocks / rows), 2 * rows, n_blocks / rows, rows};
}

Domain cut(Domain domain, std::int32_t n_elements) {
  std::int64_t shortest = std::numeric_limits<std::int64_t>::max();
  Domain best = domain;
  for (std::int32_t rows = 1; rows <= n_elements && rows <= domain.height; ++rows) {
    const std::int32_t columns = n_elements / rows;
    if (n_elements % rows != 0 || columns > domain.width) continue;
    const std::int64_t border =
        std::int64_t{rows} * domain.width + std::int64_t{columns} * domain.height;
    if (border >= shortest) continue;
    shortest = border;
    best.rows = rows;
    best.columns = columns;
  }
  if (shortest == std::numeric_limits<std::int64_t>::max())
    tess::fail(tess::ErrorCode::bad_argument, "--per-pe: ", domain.width, " x ", domain.height,
               " cells cannot be cut into ", n_elements,
               " blocks; give divisors of the largest count");
  return best;
}

}  // namespace lb_lab
