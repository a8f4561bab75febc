// A cube of space with its particles: a chare of a sparse three-dimensional array. The first
// particle that enters creates it, and it ends when it is empty at the begin of a stretch of steps.
// Particles do not collide with one another: blocks serve locality only, and no result depends on
// them.
//
// An epoch closes each stretch. Within it particles change blocks; a particle that has done its
// steps waits among the arrivals until the next stretch, so that it is not moved twice.
#pragma once

#include "apps/particles/simulation/observe.hpp"
#include "apps/particles/simulation/station.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <vector>

namespace particles {

/// Particles on their way to a block.
struct Arrivals {
  std::int32_t step = 0;  ///< steps they have done
  tess::GroupProxy<Station> stations;
  std::vector<Flock> flocks;  ///< by species

  template <class Ar>
  void serialize(Ar& ar) {
    ar(step, stations, flocks);
  }
};

class Block : public tess::Chare<Block, tess::Index3> {
 public:
  void enter(Arrivals arrivals);
  void move(const Stretch& stretch);

  // For a balancer: adjacent blocks have neighbouring positions.
  [[nodiscard]] std::array<double, 3> balance_position() const {
    return {1.0 * index().x, 1.0 * index().y, 1.0 * index().z};
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(stations_, flocks_, arrivals_);
  }

 private:
  void take_in(std::int32_t step);
  void work(const Stretch& stretch);
  void advance(std::size_t species, const Stretch& stretch, Station& station);
  static void advance_audited(Flock& flock, const tess::dn::Stepper& stepper,
                              const Stretch& stretch, Station& station);
  void look(const Stretch& stretch, Station& station);
  void send_leavers(std::int32_t step, Station& station);

  tess::GroupProxy<Station> stations_;
  std::vector<Flock> flocks_;  // by species
  std::vector<Arrivals> arrivals_;
};

}  // namespace particles
