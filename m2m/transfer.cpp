#include "m2m/transfer.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {

Task transfer(DistributedMesh source, DistributedMesh target, TransferOptions options,
              TransferSummary* summary) {
  TESS_CHECK(source.n_components == target.n_components, "the source has ", source.n_components,
             " components per vertex, the target ", target.n_components,
             "; scatter both meshes with the same number of components");
  const auto enter = [&options](const char* phase) {
    if (options.on_phase) options.on_phase(phase);
  };
  enter("broad");
  const Time start = now();
  TransferSetup setup{{}, {}, source.workers, target.workers};
  co_await epoch([&] {
    setup.collider = collide::make_collider({options.voxel_origin, options.voxel_size, {}});
    setup.id = TransferId{setup.collider.voxels.id().value};  // a transfer has its own collider
  });
  co_await epoch([&] {
    source.workers.broadcast<&Worker::submit_tets>(setup);
    target.workers.broadcast<&Worker::submit_points>(setup);
  });
  // Named, because g++ 12 destroys an aggregate twice if it is written in a co_await expression.
  const collide::Report to_target{report_to_target(target.workers, setup.id), target_model};
  co_await collide::run_collision(setup.collider, to_target);
  setup.collider.destroy();
  const Time broad = now();
  enter("narrow");
  co_await epoch([&] { target.workers.broadcast<&Worker::ask_sources>(setup.id); });
  const Time narrow = now();
  enter("report");
  OutsideRequest request{setup.id, options.policy, {}};
  if (std::holds_alternative<Nearest>(options.policy)) request.source_boxes = source.boxes;
  co_await epoch([&] { target.workers.broadcast<&Worker::resolve_outside>(request); });
  co_await epoch([&] { target.workers.broadcast<&Worker::send_ghosts>(setup.id); });
  Future<Tally> tally;
  target.workers.broadcast<&Worker::commit>(setup.id, tally.callback());
  source.workers.broadcast<&Worker::release>(setup.id);
  const Tally all = co_await tally;
  const Time report = now();
  if (summary != nullptr)
    *summary = {seconds(broad - start), seconds(narrow - broad), seconds(report - narrow), all};
}

Point suggest_voxel_size(const TetMesh& source, const TetMesh& target) {
  constexpr double tets_per_voxel = 100;
  const Aabb box = bounds(source), other = bounds(target);
  double volume = 1;
  double longest = 0, farthest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, box.hi[axis] - box.lo[axis]);
    farthest = std::max({farthest, std::abs(box.lo[axis]), std::abs(box.hi[axis]),
                         std::abs(other.lo[axis]), std::abs(other.hi[axis])});
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    volume *= std::max((box.hi[axis] - box.lo[axis]) / longest, 1e-3);  // the mesh may be flat
  const double by_density =
      longest * std::cbrt(volume * tets_per_voxel / static_cast<double>(source.n_tets()));
  // Cell indices have 32 bits.
  const double least = std::max(farthest * 0x1p-29, std::abs(longest) * 0x1p-20);
  const double size = std::max({by_density, least, std::numeric_limits<double>::min()});
  return {size, size, size};
}

}  // namespace tess::m2m
