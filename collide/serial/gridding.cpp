#include "collide/serial/gridding.hpp"

#include "collide/serial/cell_numbers.hpp"

namespace tess::collide::serial {
namespace {

/// Whether the items of a voxel have no model, one model or several models.
class ModelsSeen {
 public:
  void add(ModelId model) noexcept {
    const auto code = std::uint64_t{static_cast<std::uint32_t>(model)} + 1;
    state_ = state_ == 0 || state_ == code ? code : several_models;
  }
  [[nodiscard]] bool several() const noexcept { return state_ == several_models; }

 private:
  static constexpr std::uint64_t several_models = ~std::uint64_t{0};
  std::uint64_t state_ = 0;  // 0: none; model + 1: only this one
};

}  // namespace

VoxelGroups group_by_voxel(std::span<const Item> items, const VoxelGrid& grid, KeepVoxels keep) {
  CellBounds bounds;
  ModelsSeen all;
  for (const Item& item : items) {
    bounds.add(cells_of(item, grid), item);
    all.add(item.id.model);
  }
  if (keep == KeepVoxels::of_several_models && !all.several()) return {};
  CellNumbers numbers(bounds);
  std::vector<std::uint32_t> n_items(numbers.size());
  std::vector<ModelsSeen> models(numbers.size());
  for (const Item& item : items)
    numbers.for_each(cells_of(item, grid), [&](std::uint32_t v) {
      if (v >= n_items.size()) {
        n_items.push_back(0);
        models.emplace_back();
      }
      ++n_items[v];
      models[v].add(item.id.model);
    });

  VoxelGroups out;
  constexpr auto dropped = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t>& next =
      n_items;  // from here on: the position of the next item of each voxel
  std::uint32_t end = 0;
  for (std::uint32_t v = 0; v < n_items.size(); ++v) {
    const std::uint32_t n = n_items[v];
    next[v] = dropped;
    if (n == 0 || (keep == KeepVoxels::of_several_models && !models[v].several())) continue;
    out.cells_.push_back(numbers.cell(v));
    next[v] = end;
    end += n;
    out.first_.push_back(end);
  }
  if (end == 0) return out;
  out.items_.resize(end);
  for (std::uint32_t i = 0; i < items.size(); ++i)
    numbers.for_each(cells_of(items[i], grid), [&](std::uint32_t v) {
      if (next[v] != dropped) out.items_[next[v]++] = i;
    });
  return out;
}

}  // namespace tess::collide::serial
