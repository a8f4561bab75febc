#include "collide/parallel/voxel.hpp"

#include "collide/parallel/manager.hpp"
#include "collide/parallel/pair_search.hpp"

#include <utility>

namespace tess::collide {

Voxel::Voxel() = default;
Voxel::~Voxel() = default;

void Voxel::add(Part part, std::uint32_t n_senders) {
  is_idle_ = false;
  const std::uint64_t step = part.delivery().plan.step;
  std::vector<Part>& parts = waiting_[step];
  parts.push_back(std::move(part));
  if (parts.size() < n_senders) return;
  if (!search_at_once(parts)) {
    const GroupProxy<Manager>& managers = parts.front().delivery().managers;
    managers[my_pe()].send<&Manager::search_in_portions>(std::move(parts));
  }
  waiting_.erase(step);
}

void Voxel::retire() {
  if (is_idle_) {
    destroy();
  } else {
    is_idle_ = true;
  }
}

}  // namespace tess::collide
