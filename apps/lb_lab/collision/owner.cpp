#include "apps/lb_lab/collision/owner.hpp"

#include <tuple>
#include <utility>

namespace lb_lab {
namespace {

using Where = std::tuple<tess::CollectionId, tess::CollectionId>;  // owners, stations

/// Runs on the PE of the voxel, once per owner of a pair: only the lesser owner is sent the pair.
void send_to_lesser(const tess::Callback<tess::collide::Hits>& callback,
                    tess::collide::Hits&& hits) {
  if (hits.owner > hits.other) return;
  const auto [owners, stations] = tess::from_bytes<Where>(callback.where());
  Station& here = tess::GroupProxy<Station>(stations).local();
  const double nominal =
      static_cast<double>(hits.pairs.size()) * Clusters(here.plan().problem).seconds_a_pair();
  here.worked(nominal, nominal);
  const tess::Index1 owner = tess::collide::index_of(hits.owner);
  tess::ArrayProxy<Owner>(owners)[owner].send<&Owner::receive>(std::move(hits));
}

const tess::Callback<tess::collide::Hits>::Kind lesser_owner{
    tess::naming::name_of<&send_to_lesser>(), &send_to_lesser};

}  // namespace

void Owner::submit(const tess::collide::Collider& collider, std::int32_t iteration) {
  iteration_ = iteration;
  const Clusters clusters(stations_.local().plan().problem);
  const auto n = static_cast<std::uint64_t>(n_owners_), me = static_cast<std::uint64_t>(index().x);
  collider.submit(clusters.items(me * clusters.n_objects() / n, (me + 1) * clusters.n_objects() / n,
                                 tess::collide::owner_of(index()), iteration));
}

void Owner::receive(const tess::collide::Hits& hits) {
  for (const tess::collide::LocalPair& pair : hits.pairs)
    answer_ += answer_of_pair(pair.mine, pair.theirs, iteration_);
}

void Owner::end() {
  stations_.local().take(answer_);
  destroy();
}

tess::collide::HitReceivers report_to(tess::ArrayProxy<Owner> owners,
                                      tess::GroupProxy<Station> stations) {
  return {
      tess::Callback<tess::collide::Hits>(lesser_owner, std::in_place, owners.id(), stations.id()),
      {}};
}

}  // namespace lb_lab
