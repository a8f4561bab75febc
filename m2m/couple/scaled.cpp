#include "m2m/scaled.hpp"

#include "m2m/couple/integral_book.hpp"
#include "m2m/couple/messages.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {
namespace {

/// An integral that is a smaller part of that of the magnitude is rounding.
constexpr double least_part = 1e-12;

}  // namespace

IntegralPage& IntegralPage::operator+=(const IntegralPage& other) {
  const std::size_t n = std::max(integrals.size(), other.integrals.size());
  integrals.resize(n);
  magnitudes.resize(n, 0);
  for (std::size_t c = 0; c < other.integrals.size(); ++c) {
    integrals[c].add(other.integrals[c]);
    magnitudes[c] += other.magnitudes[c];
  }
  cells += other.cells;
  points += other.points;
  return *this;
}

IntegralPage integrals_of(const MeshView& mesh, std::span<const double> values) {
  const std::size_t n_points = mesh.points.size();
  const std::size_t n_owned = static_cast<std::size_t>(mesh.n_owned);
  const bool has_all = n_points > 0 && values.size() % n_points == 0;
  const std::size_t n_rows = has_all ? n_points : n_owned;
  IntegralPage page;
  if (n_rows == 0) return page;
  TESS_CHECK(values.size() % n_rows == 0, "a piece has ", values.size(), " values for ", n_points,
             " points, of which it owns ", n_owned, ": give a row per point");
  const std::size_t n = values.size() / n_rows;
  page.integrals.resize(n);
  page.magnitudes.resize(n, 0);
  const std::size_t n_own = mesh.own_tets().size();
  const std::size_t n_corners = static_cast<std::size_t>(mesh.dimension) + 1;
  for (std::size_t t = 0; t < (has_all ? n_own : mesh.tets.size()); ++t) {
    const double size = measure(corners_of(mesh.points, mesh.tets[t]), mesh.dimension);
    if (t < n_own) page.cells += size;
    const double part = size / static_cast<double>(n_corners);
    for (std::size_t k = 0; k < n_corners; ++k) {
      const auto v = static_cast<std::size_t>(mesh.tets[t][k]);
      if (v >= n_rows) continue;
      page.points += part;
      for (std::size_t c = 0; c < n; ++c) {
        const double term = part * values[v * n + c];
        page.integrals[c].add(term);
        page.magnitudes[c] += std::abs(term);
      }
    }
  }
  return page;
}

namespace detail {

TaskOf<FieldIntegrals> scale(AnyCoupling coupling, Giver give, Taker take) {
  const CouplingSetup setup = coupling.setup();
  if (setup.source_values != Centring::nodes || setup.target_values != Centring::nodes)
    fail(ErrorCode::bad_argument,
         "values in cells are not scaled: couple with values in nodes, or by a conservative kind");
  GroupProxy<IntegralBook> book;
  co_await epoch([&] { book = create<IntegralBook>(each_pe); });
  co_await epoch([&] { setup.source.broadcast<&AnyPiece::m2m_integrate>(setup.id, book, give); });
  const IntegralPage from = co_await book.reduce<&IntegralBook::close_page>();
  co_await epoch(
      [&] { setup.target.broadcast<&AnyPiece::m2m_integrate_taken>(setup.id, book, take); });
  const IntegralPage to = co_await book.reduce<&IntegralBook::close_page>();
  co_await epoch([&] { book.destroy(); });
  if (!(from.cells > 0 && to.cells > 0))
    fail(ErrorCode::bad_mesh, "the ", from.cells > 0 ? "target" : "source",
         " has no cells to integrate over: show tetrahedra or triangles (MeshView::tets)");
  if (!(std::abs(to.points - to.cells) <= 1e-9 * to.cells))
    fail(ErrorCode::bad_mesh, "pieces of the target show cells of the size ", to.points,
         " around their points, of ", to.cells,
         ": show a halo of one layer (MeshView::n_own_tets)");
  FieldIntegrals integrals;
  std::vector<double> factors;
  for (std::size_t c = 0; c < to.integrals.size(); ++c) {
    const double have = to.integrals[c].total(), want = from.integrals.at(c).total();
    integrals.target.push_back(have);
    integrals.source.push_back(want);
    const bool is_zero = std::abs(have) <= least_part * to.magnitudes[c];
    if (is_zero && !(std::abs(want) <= least_part * from.magnitudes[c]))
      fail(ErrorCode::bad_value, "component ", c, " of the target has the integral ", have,
           ", and that of the source is ", want,
           ": no factor scales it; use a conservative kind, or leave it as apply() gives it");
    factors.push_back(is_zero ? 1 : want / have);
  }
  co_await epoch([&] { setup.target.broadcast<&AnyPiece::m2m_scale>(setup.id, take, factors); });
  co_return integrals;
}

}  // namespace detail

}  // namespace tess::m2m
