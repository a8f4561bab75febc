#include "apps/particles/scene/box_union.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace particles {

using namespace tess::dn;

Surface union_of(const std::vector<Bounds>& boxes) {
  // The planes of all faces cut space into cells; a cell is named by its low corner, and those
  // beyond the last planes are empty.
  using Cell = std::array<std::size_t, 3>;
  constexpr double most_cells = 1e8;
  std::array<std::vector<double>, 3> planes;
  double n_cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double>& at = planes[static_cast<std::size_t>(axis)];
    for (const Bounds& box : boxes)
      at.insert(at.end(), {component(box.low, axis), component(box.high, axis)});
    tess::sort_unique(at);
    n_cells *= static_cast<double>(at.size());
  }
  if (n_cells > most_cells)
    tess::fail(tess::ErrorCode::bad_value, boxes.size(), " boxes cut one another into ", n_cells,
               " cells, above ", most_cells, "; join some of them, or give a file of the surface");
  const auto number = [&](const Cell& c) {
    return (c[2] * planes[1].size() + c[1]) * planes[0].size() + c[0];
  };
  const auto cell_of = [&](Vec3 corner) {
    const auto on = [](const std::vector<double>& at, double x) {
      return static_cast<std::size_t>(std::ranges::lower_bound(at, x) - at.begin());
    };
    return Cell{on(planes[0], corner.x), on(planes[1], corner.y), on(planes[2], corner.z)};
  };
  std::vector<std::uint8_t> filled(static_cast<std::size_t>(n_cells));
  for (const Bounds& box : boxes) {
    const Cell low = cell_of(box.low), high = cell_of(box.high);
    for (std::size_t k = low[2]; k < high[2]; ++k)
      for (std::size_t j = low[1]; j < high[1]; ++j)
        for (std::size_t i = low[0]; i < high[0]; ++i) filled[number({i, j, k})] = 1;
  }

  Surface surface;
  std::map<std::size_t, std::uint32_t> known;
  const auto vertex = [&](const Cell& c) {
    const auto [at, is_new] =
        known.try_emplace(number(c), static_cast<std::uint32_t>(surface.vertices.size()));
    if (is_new) surface.vertices.push_back({planes[0][c[0]], planes[1][c[1]], planes[2][c[2]]});
    return at->second;
  };
  // The face between a cell and the one below it on an axis, if only one of them is filled.
  const auto face = [&](const Cell& c, std::size_t axis) {
    Cell under = c;
    --under[axis];
    const bool above = filled[number(c)] != 0, below = c[axis] > 0 && filled[number(under)] != 0;
    if (above == below) return;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    Cell beside = c, opposite = c, over = c;
    ++beside[u], ++opposite[u], ++opposite[v], ++over[v];
    const std::uint32_t a = vertex(c), b = vertex(beside), d = vertex(opposite), e = vertex(over);
    surface.triangles.push_back(below ? std::array{a, b, d} : std::array{a, d, b});
    surface.triangles.push_back(below ? std::array{a, d, e} : std::array{a, e, d});
  };
  for (std::size_t k = 0; k < planes[2].size(); ++k)
    for (std::size_t j = 0; j < planes[1].size(); ++j)
      for (std::size_t i = 0; i < planes[0].size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) face({i, j, k}, axis);
  return surface;
}

}  // namespace particles
