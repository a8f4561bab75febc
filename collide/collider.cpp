#include "collide/collider.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <exception>
#include <utility>

namespace tess::collide {

Collider make_collider(const ColliderOptions& options) {
  if (options.size != Point{0, 0, 0})
    static_cast<void>(VoxelGrid(options.origin, options.size));  // throws
  if (!(options.piece_length >= 0))
    fail(ErrorCode::bad_argument, "make_collider() with pieces of length ", options.piece_length,
         ": give a positive length, infinity for whole objects, or 0 to have it chosen");
  const auto voxels = create<Voxel>(sparse);
  return {voxels, create_group<Manager>(voxels), options};
}

void Collider::submit_early(Submission objects) const {
  if (Manager* manager = managers.local_or_null())
    manager->receive(objects);
  else
    managers[my_pe()].send<&Manager::receive>(std::move(objects));
}

namespace {

void check_not_destroyed_early(bool is_right) {
  TESS_CHECK(
      is_right,
      "a collider is destroyed while a collision of it runs: co_await run_collision() first");
}

}  // namespace

void Collider::destroy() const {
  const Manager* const manager = managers.local_or_null();
  check_not_destroyed_early(manager == nullptr || !manager->is_colliding());
  voxels.destroy();
  managers.destroy();
}

Task run_collision(Collider collider, Report report, Callback<void> taken) {
  if (!report.call)
    fail(ErrorCode::bad_argument,
         "run_collision() with a report that nothing receives: its hits would be lost; give it "
         "report_to<&Client::receive>(clients)");
  const ColliderOptions& o = collider.options;
  const std::uint64_t step = collider.managers.local().new_step();
  Future<Summary> known;
  collider.managers.broadcast<&Manager::prepare>(step, n_sampled_per_pe(o.size, n_pes()),
                                                 known.callback());
  const Summary summary = co_await known;
  if (taken) taken();
  Plan plan;
  std::exception_ptr refused;
  try {
    plan = make_plan(summary, n_pes(), o, step);
  } catch (...) {
    refused = std::current_exception();
  }
  const auto body = [&] { collider.managers.broadcast<&Manager::begin>(step, plan, report); };
  co_await epoch(body);
  Manager* const manager = collider.managers.local_or_null();
  check_not_destroyed_early(manager != nullptr);
  manager->end_step();
  if (refused) std::rethrow_exception(refused);
}

void report_statistics(const Collider& collider, const Callback<CollisionStatistics>& target) {
  collider.managers.broadcast<&Manager::report_last>(target);
}

void retire(const Collider& collider) {
  collider.voxels.broadcast<&Voxel::retire>();
  collider.managers.broadcast<&Manager::shrink>();
}

}  // namespace tess::collide
