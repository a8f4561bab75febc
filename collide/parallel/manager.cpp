#include "collide/parallel/manager.hpp"

#include <utility>

namespace tess::collide {

void Manager::submit(std::vector<Item> items) {
  serial::CellBounds bounds = bounds_;
  for (const Item& item : items) bounds.add(serial::cells_of(item, grid_), item);
  bounds_ = bounds;
  if (!items.empty()) lists_.push_back(std::move(items));
}

void Manager::deliver() {
  const auto lists = std::exchange(lists_, {});
  serial::CellNumbers numbers(std::exchange(bounds_, {}));
  const auto for_each_entry = [&](auto&& visit) {
    for (const std::vector<Item>& items : lists)
      for (const Item& item : items)
        numbers.for_each(serial::cells_of(item, grid_), [&](std::uint32_t v) { visit(v, item); });
  };

  std::vector<std::uint32_t> n_items;
  for_each_entry([&](std::uint32_t v, const Item& /*item*/) {
    if (v >= n_items.size()) n_items.resize(numbers.size());
    ++n_items[v];
  });
  std::vector<std::vector<Item>> by_voxel(n_items.size());
  for (std::size_t v = 0; v < by_voxel.size(); ++v) by_voxel[v].reserve(n_items[v]);
  for_each_entry([&](std::uint32_t v, const Item& item) { by_voxel[v].push_back(item); });

  for (std::uint32_t v = 0; v < by_voxel.size(); ++v) {
    if (by_voxel[v].empty()) continue;
    n_delivered_ += by_voxel[v].size();
    const Cell cell = numbers.cell(v);
    voxels_[{cell.x, cell.y, cell.z}].send_or_create_here<&Voxel::add>(std::move(by_voxel[v]));
  }
}

}  // namespace tess::collide
