// A Hilbert curve through the positions, cut into one piece per PE. It is cheaper than rcb, and a
// small change of loads moves few elements.
#include "runtime/core/hilbert.hpp"

#include "runtime/balance/capacity.hpp"
#include "runtime/balance/honour.hpp"
#include "runtime/balance/relabel.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::balance {
namespace {

constexpr unsigned bits = 20;

/// Cells of a cube as wide as the longest extent. Axes without extent are left out, since the curve
/// in three dimensions is not connected within a plane.
struct Grid {
  std::vector<std::size_t> axes;
  std::array<double, 3> low{};
  double cells_per_length = 0;

  explicit Grid(const std::vector<std::array<double, 3>>& position) {
    double longest = 0;
    for (std::size_t axis = 0; axis < 3 && !position.empty(); ++axis) {
      const auto [least, most] =
          std::ranges::minmax(position, {}, [axis](const auto& point) { return point[axis]; });
      low[axis] = least[axis];
      if (most[axis] > least[axis]) axes.push_back(axis);
      longest = std::max(longest, most[axis] - least[axis]);
    }
    if (longest > 0) cells_per_length = ((1U << bits) - 1) / longest;
  }

  [[nodiscard]] std::uint64_t key(const std::array<double, 3>& point) const {
    std::array<std::uint32_t, 3> cell{};
    for (std::size_t k = 0; k < axes.size(); ++k)
      cell[k] = static_cast<std::uint32_t>((point[axes[k]] - low[axes[k]]) * cells_per_length);
    return hilbert_key(cell, axes.size(), bits);
  }
};

}  // namespace

/// Throws Error if the snapshot has no positions. O(n log n).
Assignment hilbert(const Snapshot& s) {
  if (s.elements.position.empty() && s.elements.size() > 0)
    fail(ErrorCode::bad_argument,
         "strategy hilbert: the snapshot has no positions; define balance_position() in the chare");
  const Grid grid(s.elements.position);
  std::vector<std::pair<std::uint64_t, std::size_t>> curve;
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (s.elements.migratable[i]) curve.emplace_back(grid.key(s.elements.position[i]), i);
  std::ranges::sort(curve);

  const std::vector<double> weight = weights(s);
  const std::vector<double> capacity = capacities(s);
  Assignment wanted = s.elements.pe;
  std::size_t pe = 0;
  double end = capacity[0];  // end of this PE's piece, measured along the curve by weight
  double done = 0;
  for (const auto& [key, i] : curve) {
    while (done + weight[i] / 2 > end && pe + 1 < capacity.size()) end += capacity[++pe];
    done += weight[i];
    wanted[i] = pe_at(pe);
  }
  return honour(s, relabel(s, std::move(wanted)));
}

}  // namespace tess::balance
