#include "collide/parallel/manager.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

namespace tess {

void Manager::submit(std::span<const Item> items) {
  check_boxes(items);
  for (const Item& item : items)
    (void)grid_.cells_of(item.box);  // refuses what is beyond the grid, before anything is sent
  items_.insert(items_.end(), items.begin(), items.end());
}

void Manager::deliver() {
  boost::unordered_flat_map<Cell, std::vector<Item>, std::hash<Cell>> by_voxel;
  for (const Item& item : items_) {
    const CellRange range = grid_.cells_of(item.box);
    for (std::int32_t x = range.lo.x; x <= range.hi.x; ++x)
      for (std::int32_t y = range.lo.y; y <= range.hi.y; ++y)
        for (std::int32_t z = range.lo.z; z <= range.hi.z; ++z)
          by_voxel[Cell{x, y, z}].push_back(item);
  }
  items_ = {};
  for (auto& [cell, items] : by_voxel) {
    n_delivered_ += items.size();
    voxels_[{cell.x, cell.y, cell.z}].send_or_create_here<&Voxel::add>(std::move(items));
  }
}

}  // namespace tess
