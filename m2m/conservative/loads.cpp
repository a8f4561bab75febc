#include "m2m/conservative/loads.hpp"

#include "m2m/interpolate/orientation.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tess::m2m {
namespace {

std::size_t n_unknowns(MeshView mesh, Basis basis) {
  if (basis == Basis::vertex) return mesh.points.size();
  return basis == Basis::cell ? mesh.tets.size() : 4 * mesh.tets.size();
}

/// The unknown of a corner. All corners of a cell share one; their contributions add up, since the
/// four weights add up to one.
VertexId unknown(const Tet& tet, std::int32_t number, std::size_t corner, Basis basis) {
  if (basis == Basis::vertex) return tet[corner];
  return basis == Basis::cell ? number : 4 * number + static_cast<std::int32_t>(corner);
}

struct Entry {
  VertexId row;
  VertexId column;
  double weight;
};

/// The entries of one pair; at most 16.
struct PairEntries {
  std::array<Entry, 16> entries;
  std::size_t n = 0;
  void add(VertexId row, VertexId column, double weight) {
    for (std::size_t k = 0; k < n; ++k) {
      if (entries[k].row != row || entries[k].column != column) continue;
      entries[k].weight += weight;
      return;
    }
    entries[n++] = {row, column, weight};
  }
};

/// Sorts entries into rows, and adds those of the same column in their order.
Rows<double> rows_of(std::span<const Entry> entries, std::size_t n_rows, std::size_t n_columns) {
  std::vector<std::uint64_t> begin(n_rows + 1, 0);
  for (const Entry& entry : entries) ++begin[static_cast<std::size_t>(entry.row) + 1];
  for (std::size_t row = 0; row < n_rows; ++row) begin[row + 1] += begin[row];
  std::vector<std::uint64_t> next(begin.begin(), begin.end() - 1);
  std::vector<std::uint64_t> order(entries.size());
  for (std::size_t k = 0; k < entries.size(); ++k)
    order[next[static_cast<std::size_t>(entries[k].row)]++] = k;
  Rows<double> rows;
  std::vector<double> sum(n_columns, 0.0);
  std::vector<std::uint8_t> used(n_columns, 0);
  std::vector<VertexId> columns;
  for (std::size_t row = 0; row < n_rows; ++row) {
    columns.clear();
    for (std::uint64_t k = begin[row]; k < begin[row + 1]; ++k) {
      const Entry& entry = entries[order[k]];
      const auto column = static_cast<std::size_t>(entry.column);
      if (used[column] == 0) columns.push_back(entry.column);
      used[column] = 1;
      sum[column] += entry.weight;
    }
    std::sort(columns.begin(), columns.end());
    for (const VertexId c : columns) {
      const auto column = static_cast<std::size_t>(c);
      rows.add(c, sum[column]);
      sum[column] = 0;
      used[column] = 0;
    }
    rows.end_row();
  }
  return rows;
}

/// Adds the entries of the same row and column. The order of addition stays, so the sums have the
/// same bits however often this is called.
void merge_entries(std::vector<Entry>& entries, std::size_t n_rows, std::size_t n_columns) {
  const Rows<double> rows = rows_of(entries, n_rows, n_columns);
  entries.clear();
  for (std::size_t row = 0; row < n_rows; ++row)
    for (std::uint64_t k = rows.begin[row]; k < rows.begin[row + 1]; ++k)
      entries.push_back({static_cast<VertexId>(row), rows.columns[k], rows.weights[k]});
}

/// Entries are merged when there are so many, and again when there are four times as many as after
/// the last time. Without that, they take ten times the memory of the rows.
constexpr std::size_t first_merge = std::size_t{1} << 18;

}  // namespace

Loads integrate_pairs(MeshView source, Basis source_basis, MeshView target, Basis target_basis,
                      std::span<const TetPair> pairs) {
  Loads loads;
  loads.coverage.resize(target.tets.size());
  const std::size_t n_rows = n_unknowns(target, target_basis);
  const std::size_t n_columns = n_unknowns(source, source_basis);
  std::vector<Entry> entries;
  std::size_t next_merge = first_merge;
  for (const TetPair& pair : pairs) {
    if (entries.size() > next_merge) {
      merge_entries(entries, n_rows, n_columns);
      next_merge = std::max(first_merge, 4 * entries.size());
    }
    const Tet& s = source.tets[static_cast<std::size_t>(pair.source)];
    const Tet& t = target.tets[static_cast<std::size_t>(pair.target)];
    const PairMoments moments =
        pair_moments(corners_of(source.points, s), corners_of(target.points, t));
    if (!(moments.volume > 0)) continue;
    ++loads.n_overlaps;
    loads.coverage[static_cast<std::size_t>(pair.target)].add(moments);
    PairEntries block;
    for (std::size_t b = 0; b < 4; ++b)
      for (std::size_t a = 0; a < 4; ++a)
        block.add(unknown(t, pair.target, b, target_basis),
                  unknown(s, pair.source, a, source_basis), moments.mixed[a][b]);
    entries.insert(entries.end(), block.entries.begin(),
                   block.entries.begin() + static_cast<std::ptrdiff_t>(block.n));
  }
  loads.rows = rows_of(entries, n_rows, n_columns);
  return loads;
}

void cell_means(MeshView target, std::span<const CellCoverage> coverage, std::size_t n_components,
                double fallback, std::span<double> loads) {
  TESS_CHECK(loads.size() == target.tets.size() * n_components, "expected ", target.tets.size(),
             " rows of ", n_components, " components, got ", loads.size(), " numbers");
  const std::vector<double> fractions = covered_fractions(target.points, target.tets, coverage);
  for (std::size_t t = 0; t < target.tets.size(); ++t) {
    for (std::size_t c = 0; c < n_components; ++c) {
      double& value = loads[t * n_components + c];
      value = fractions[t] > no_coverage ? value / coverage[t].volume : fallback;
    }
  }
}

}  // namespace tess::m2m
