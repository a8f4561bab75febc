#include "m2m/transfer.hpp"

#include "runtime/core/check.hpp"

namespace tess::m2m {

Transfer::Transfer(const DistributedMesh& source, const DistributedMesh& target,
                   const TransferOptions& options)
    : coupling_(source.workers, target.workers, options), target_(target.workers) {
  TESS_CHECK(source.n_components == target.n_components, "the source has ", source.n_components,
             " components per vertex, the target ", target.n_components,
             "; scatter both meshes with the same number of components");
  require_dimensions(options.kind, options.tolerance, source.dimension, target.dimension);
  const auto check_halo = [&](const DistributedMesh& mesh, const char* side, std::int32_t layers) {
    TESS_CHECK(mesh.n_parts == 1 || mesh.halo_layers >= layers, "kind ", name_of(options.kind),
               " needs ", layers, " halo layers: scatter the ", side, " with these instead of ",
               mesh.halo_layers);
  };
  check_halo(source, "source", source_halo_layers(options.kind));
  check_halo(target, "target", target_halo_layers(options.kind));
  TESS_CHECK(options.source_values == Centring::nodes && options.target_values == Centring::nodes,
             "a DistributedMesh has values at nodes; values in cells are for own chares "
             "(coupling.hpp)");
}

Task Transfer::apply() {
  // A commit after the next application has begun would take what that has given so far.
  return coupling_.apply<&Worker::values, &Worker::pending>(
      [target = target_](CouplingId id) { target.broadcast<&Worker::commit>(id); });
}

TaskOf<TransferSummary> transfer(DistributedMesh source, DistributedMesh target,
                                 TransferOptions options) {
  Transfer handle(source, target, options);
  TransferSummary summary;
  summary.search = co_await handle.search();
  if (options.on_phase != nullptr) (*options.on_phase)("apply");
  const Time start = now();
  co_await handle.apply();
  summary.apply = seconds(now() - start);
  co_await epoch([&] { handle.destroy(); });
  co_return summary;
}

}  // namespace tess::m2m
