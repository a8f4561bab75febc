#include "collide/serial/pair_search.hpp"

#include <algorithm>

namespace tess::collide::serial {

PairSearch::Models PairSearch::count_models(std::span<const Item> items) noexcept {
  const ModelId first = items.front().id.model;
  Models models{1, {}, 0};
  for (const Item& item : items) {
    const ModelId model = item.id.model;
    if (model == first) continue;
    if (models.n == 1) models = {2, model, 0};
    if (model != models.second) return {3, {}, 0};
    ++models.n_second;
  }
  return models;
}

void PairSearch::set_below(std::span<const Item> items, const Cell& cell, const VoxelGrid& grid) {
  below_.resize(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    CellRange range;
    if (!grid.find_cells(items[i].box, range)) range = grid.cells_of(items[i].box);
    below_[i] = axes_below(range.lo, cell);
  }
}

std::vector<PairSearch::Entry> PairSearch::whole(std::span<const Item> items) const {
  std::vector<Entry> node;
  node.reserve(items.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) node.emplace_back(i, below_[i]);
  return node;
}

void PairSearch::fill(std::span<const Item> items, const std::vector<Entry>& node) {
  resize_lanes(node.size());
  for (std::size_t i = 0; i < node.size(); ++i)
    lanes_.set(i, items[node[i].first], node[i].second, node[i].first);
}

std::optional<std::array<std::vector<PairSearch::Entry>, 2>> PairSearch::halves(
    std::span<const Item> items, const std::vector<Entry>& node) {
  constexpr std::size_t leaf_size = 32;
  if (node.size() <= leaf_size) return std::nullopt;
  Point spread{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto lower = [&](const Entry& e) { return items[e.first].box.lo[k]; };
    const auto less = [&](const Entry& a, const Entry& b) { return lower(a) < lower(b); };
    const auto [least, most] = std::minmax_element(node.begin(), node.end(), less);
    spread[k] = lower(*most) - lower(*least);
  }
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](auto a, auto b) { return spread[a] > spread[b]; });
  std::vector<double> lower(node.size());
  for (const std::size_t axis : axes) {
    for (std::size_t i = 0; i < node.size(); ++i) lower[i] = items[node[i].first].box.lo[axis];
    const auto middle = lower.begin() + static_cast<std::ptrdiff_t>(lower.size() / 2);
    std::nth_element(lower.begin(), middle, lower.end());
    const double plane = *middle;
    std::array<std::vector<Entry>, 2> out;
    for (const Entry& e : node) {
      const Aabb& box = items[e.first].box;
      const bool starts_before = box.lo[axis] < plane;
      if (starts_before) out[0].push_back(e);
      if (box.hi[axis] >= plane)
        out[1].emplace_back(e.first, e.second | (starts_before ? 1u << axis : 0u));
    }
    // A split must make both halves much smaller. If many boxes touch the plane, one half can be
    // the whole node again, and the recursion would be deep without any gain.
    const std::size_t larger = std::max(out[0].size(), out[1].size());
    if (10 * larger <= 9 * node.size() && 2 * (out[0].size() + out[1].size()) <= 3 * node.size())
      return out;
  }
  return std::nullopt;
}

}  // namespace tess::collide::serial
