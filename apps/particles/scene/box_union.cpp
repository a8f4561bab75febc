#include "apps/particles/scene/box_union.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace particles {
namespace {
using namespace tess::dn;

using Cell = std::array<std::size_t, 3>;

/// Space cut by the planes of all faces: cells that are in a box or in none.
class Cells {
 public:
  explicit Cells(const std::vector<Bounds>& boxes) {
    constexpr double most = 1e8;
    double n_cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<double>& at = planes_[axis];
      for (const Bounds& box : boxes)
        for (const Vec3 corner : {box.low, box.high})
          at.push_back(component(corner, static_cast<int>(axis)));
      std::sort(at.begin(), at.end());
      at.erase(std::unique(at.begin(), at.end()), at.end());
      n_cells *= static_cast<double>(at.size());
    }
    if (n_cells > most)
      tess::fail(tess::ErrorCode::bad_value, boxes.size(), " boxes cut one another into ", n_cells,
                 " cells, above ", most, "; join some of them, or give a file of the surface");
    filled_.assign(static_cast<std::size_t>(n_cells), 0);
    for (const Bounds& box : boxes) {
      const Cell low = cell_of(box.low), high = cell_of(box.high);
      for (std::size_t k = low[2]; k < high[2]; ++k)
        for (std::size_t j = low[1]; j < high[1]; ++j)
          for (std::size_t i = low[0]; i < high[0]; ++i) filled_[number({i, j, k})] = 1;
    }
  }

  [[nodiscard]] const std::array<std::vector<double>, 3>& planes() const { return planes_; }
  [[nodiscard]] std::size_t number(const Cell& c) const {
    return (c[2] * planes_[1].size() + c[1]) * planes_[0].size() + c[0];
  }
  /// The cell above this corner; those beyond the last planes are empty.
  [[nodiscard]] bool is_filled(const Cell& c) const { return filled_[number(c)] != 0; }
  [[nodiscard]] bool is_filled_below(Cell c, std::size_t axis) const {
    if (c[axis] == 0) return false;
    --c[axis];
    return is_filled(c);
  }

 private:
  [[nodiscard]] Cell cell_of(Vec3 corner) const {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<double>& at = planes_[axis];
      cell[axis] = static_cast<std::size_t>(
          std::lower_bound(at.begin(), at.end(), component(corner, static_cast<int>(axis))) -
          at.begin());
    }
    return cell;
  }

  std::array<std::vector<double>, 3> planes_;
  std::vector<std::uint8_t> filled_;
};

}  // namespace

Surface union_of(const std::vector<Bounds>& boxes) {
  const Cells cells(boxes);
  const auto& planes = cells.planes();
  Surface surface;
  std::map<std::size_t, std::uint32_t> known;
  const auto vertex = [&](const Cell& c) {
    const auto [at, is_new] =
        known.try_emplace(cells.number(c), static_cast<std::uint32_t>(surface.vertices.size()));
    if (is_new) surface.vertices.push_back({planes[0][c[0]], planes[1][c[1]], planes[2][c[2]]});
    return at->second;
  };
  // The face between a cell and the one below it on an axis.
  const auto face = [&](const Cell& c, std::size_t axis) {
    const bool above = cells.is_filled(c), below = cells.is_filled_below(c, axis);
    if (above == below) return;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    Cell beside = c, opposite = c, over = c;
    ++beside[u], ++opposite[u], ++opposite[v], ++over[v];
    const std::uint32_t a = vertex(c), b = vertex(beside), d = vertex(opposite), e = vertex(over);
    if (below) {
      surface.triangles.push_back({a, b, d});
      surface.triangles.push_back({a, d, e});
    } else {
      surface.triangles.push_back({a, d, b});
      surface.triangles.push_back({a, e, d});
    }
  };
  for (std::size_t k = 0; k < planes[2].size(); ++k)
    for (std::size_t j = 0; j < planes[1].size(); ++j)
      for (std::size_t i = 0; i < planes[0].size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) face({i, j, k}, axis);
  return surface;
}

}  // namespace particles
