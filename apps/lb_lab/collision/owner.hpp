// Owns some of the objects of a collision: submits them to the collider in each iteration, receives
// their pairs, and adds those to the answer. Owners do not migrate; the collider's voxels, which
// find the pairs, are balanced.
#pragma once

#include "apps/lb_lab/collision/clusters.hpp"
#include "apps/lb_lab/run/station.hpp"
#include "collide/collider.hpp"
#include "runtime/runtime.hpp"

namespace lb_lab {

class Owner : public tess::Chare<Owner, tess::Index1> {
 public:
  Owner() = default;
  Owner(tess::GroupProxy<Station> stations, std::int32_t n_owners)
      : stations_(stations), n_owners_(n_owners) {}

  // Entry methods.
  void submit(const tess::collide::Collider& collider, std::int32_t iteration);
  void receive(const tess::collide::Hits& hits);
  void end();

  template <class Ar>
  void serialize(Ar& ar) {
    ar(stations_, n_owners_, iteration_, answer_);
  }

 private:
  tess::GroupProxy<Station> stations_;
  std::int32_t n_owners_ = 1, iteration_ = 0;
  std::uint64_t answer_ = 0;
};

/// The receivers of hits: one of the two owners of a pair, once. The station of the PE where
/// the voxel is is charged.
[[nodiscard]] tess::collide::HitReceivers report_to(tess::ArrayProxy<Owner> owners,
                                                    tess::GroupProxy<Station> stations);

}  // namespace lb_lab
