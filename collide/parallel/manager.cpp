#include "collide/parallel/manager.hpp"

#include "collide/serial/gridding.hpp"

namespace tess {

void Manager::submit(std::span<const Item> items) {
  check_boxes(items);
  for (const Item& item : items)
    (void)grid_.cells_of(item.box);  // refuses what is beyond the grid, before anything is sent
  items_.insert(items_.end(), items.begin(), items.end());
}

void Manager::deliver() {
  const VoxelGroups groups = group_by_voxel(items_, grid_);
  for (std::size_t voxel = 0; voxel < groups.size(); ++voxel) {
    const Cell& cell = groups.cell(voxel);
    std::vector<Item> items;
    items.reserve(groups.items(voxel).size());
    for (const std::uint32_t i : groups.items(voxel)) items.push_back(items_[i]);
    n_delivered_ += items.size();
    voxels_[{cell.x, cell.y, cell.z}].send_or_create_here<&Voxel::add>(std::move(items));
  }
  items_ = {};
}

}  // namespace tess
