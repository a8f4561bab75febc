#include "m2m/transfer.hpp"

#include "runtime/core/check.hpp"

namespace tess::m2m {

Transfer::Transfer(const DistributedMesh& source, const DistributedMesh& target,
                   const TransferOptions& options)
    : coupling_(source.workers, target.workers, options), target_(target.workers) {
  TESS_CHECK(source.n_components == target.n_components, "the source has ", source.n_components,
             " components per vertex, the target ", target.n_components,
             "; scatter both meshes with the same number of components");
  TESS_CHECK(source.n_parts == 1 || source.halo_layers >= halo_layers(options.kind),
             "this kind of transfer needs gradients: scatter the source with ",
             halo_layers(options.kind), " halo layers instead of ", source.halo_layers);
}

Task Transfer::apply() {
  co_await coupling_.apply<&Worker::values, &Worker::pending>();
  co_await epoch([&] { target_.broadcast<&Worker::commit>(coupling_.id()); });
}

Task transfer(DistributedMesh source, DistributedMesh target, TransferOptions options,
              TransferSummary* summary) {
  Transfer handle(source, target, options);
  SearchSummary search;
  co_await handle.search(&search);
  if (options.on_phase) options.on_phase("apply");
  const Time start = now();
  co_await handle.apply();
  const Time end = now();
  co_await epoch([&] { handle.destroy(); });
  if (summary != nullptr)
    *summary = {search.broad, search.narrow, seconds(end - start), search.tally};
}

}  // namespace tess::m2m
