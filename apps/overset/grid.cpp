#include "apps/overset/grid.hpp"

namespace overset {

Rows JoinRows::operator()(Rows a, const Rows& b) const {
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  a.iblank.insert(a.iblank.end(), b.iblank.begin(), b.iblank.end());
  a.quality.insert(a.quality.end(), b.quality.begin(), b.quality.end());
  a.values.insert(a.values.end(), b.values.begin(), b.values.end());
  return a;
}

void Grid::cut() {
  blanking_.cut(mesh_view(), load_.walls, load_.on_outer, load_.options);
  for (std::size_t v = 0; v < load_.values.size(); ++v)
    if (blanking_.roles()[v] == tess::m2m::Role::hole) load_.values[v] = 0;
  taken_.clear();
}

std::span<double> Grid::taken(tess::m2m::CouplingId from) {
  std::vector<double>& taken = taken_[from];
  taken.resize(static_cast<std::size_t>(load_.part.n_owned));
  return taken;
}

void Grid::use(tess::m2m::CouplingId from, std::int32_t mesh_number) {
  const std::span<const double> taken = this->taken(from);
  for (std::size_t v = 0; v < taken.size(); ++v)
    if (blanking_.iblank()[v] == -mesh_number) load_.values[v] = taken[v];
}

void Grid::gather(tess::Callback<Rows> result) {
  const auto owned = static_cast<std::ptrdiff_t>(load_.part.n_owned);
  const auto of_owned = [owned](const auto& list) {
    return std::vector(list.begin(), list.begin() + owned);
  };
  Rows mine{of_owned(load_.part.point_ids),
            {blanking_.iblank().begin(), blanking_.iblank().end()},
            {blanking_.quality().begin(), blanking_.quality().end()},
            of_owned(load_.values)};
  contribute(JoinRows{}, std::move(mine), std::move(result));
}

}  // namespace overset
