#include "collide/collider.hpp"

namespace tess::collide {

Collider make_collider(const ColliderOptions& options) {
  const VoxelGrid checked(options.origin, options.size);
  const auto voxels = create<Voxel>(sparse);
  return {voxels, create_group<Manager>(checked.origin(), checked.size(), voxels), options};
}

void start_delivery(const Collider& collider) {
  collider.managers.broadcast<&Manager::deliver>();
}

void start_collision(const Collider& collider, const Report& report) {
  const ColliderOptions& o = collider.options;
  collider.voxels.broadcast<&Voxel::start_collision>(Collision{o.origin, o.size, o.rules, report});
}

Task run_collision(Collider collider, Report report) {
  const auto deliver = [&collider] { start_delivery(collider); };
  const auto collide_all = [&collider, &report] { start_collision(collider, report); };
  co_await epoch(deliver);
  co_await epoch(collide_all);
}

}  // namespace tess::collide
