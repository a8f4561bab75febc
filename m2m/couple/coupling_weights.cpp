#include "m2m/coupling_weights.hpp"

#include "m2m/couple/row_book.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace tess::m2m {

void require_weights(TransferKind kind, bool clamp) {
  if (clamp)
    fail(ErrorCode::bad_argument,
         "values that are clamped are no matrix times the source values: "
         "leave out clamp for weights");
  if (kind == TransferKind::limited || is_conservative(kind))
    fail(ErrorCode::bad_argument, "kind ", name_of(kind),
         " has no weights: its values are limited, or solve a system; choose linear or "
         "second-order");
}

WeightMatrix matrix_of(const GlobalRows& rows, std::int64_t n_sources, std::int64_t n_targets) {
  const auto check = [](const char* what, GlobalId id, std::int64_t n) {
    if (id < 0 || id >= n)
      fail(ErrorCode::bad_value, "weights need ", what, " vertices with ids from 0 to ", n - 1,
           ", but one has the id ", id, "; number the vertices without gaps");
  };
  std::vector<std::uint64_t> begin{0};
  for (const std::uint64_t size : rows.sizes) begin.push_back(begin.back() + size);
  std::vector<std::size_t> order(rows.targets.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return rows.targets[a] < rows.targets[b]; });
  WeightMatrix matrix;
  matrix.n_columns = n_sources;
  GlobalId next = 0;
  for (const std::size_t i : order) {
    const GlobalId target = rows.targets[i];
    check("target", target, n_targets);
    if (target < next)
      fail(ErrorCode::bad_value, "two target vertices have the id ", target,
           "; number the vertices of all pieces together, and show them with view_of(): for a "
           "MeshPiece ghosts are targets, too");
    for (; next < target; ++next) matrix.rows.end_row();
    for (std::uint64_t k = begin[i]; k < begin[i + 1]; ++k) {
      check("source", rows.columns[k], n_sources);
      matrix.rows.add(static_cast<VertexId>(rows.columns[k]), rows.weights[k]);
    }
    matrix.rows.end_row();
    ++next;
  }
  for (; next < n_targets; ++next) matrix.rows.end_row();
  return matrix;
}

TaskOf<WeightMatrix> collect_weights(const AnyCoupling& coupling, std::int64_t n_sources,
                                     std::int64_t n_targets) {
  const CouplingSetup setup = coupling.setup();
  TESS_CHECK(
      setup.id != CouplingId{},
      "weights of a coupling are collected before its first search: co_await search() first");
  require_weights(setup.kind, setup.clamp);
  TESS_CHECK(!setup.applies_at_target(),
             "weights that the target applies are not collected, of kind ", name_of(setup.kind),
             " or of a transposed coupling: collect those of a linear coupling, and transpose "
             "them");
  TESS_CHECK(setup.source_values == Centring::nodes,
             "weights are of values at points, and the coupling's source values are in ",
             rows_of(setup.source_values));
  GroupProxy<RowBook> book;
  co_await epoch([&] { book = create<RowBook>(each_pe); });
  co_await epoch([&] { setup.source.broadcast<&AnyPiece::m2m_give_rows>(setup.id, book); });
  const GlobalRows rows = co_await book.reduce<&RowBook::close_page>();
  co_await epoch([&] { book.destroy(); });
  co_return matrix_of(rows, n_sources, n_targets);
}

}  // namespace tess::m2m
