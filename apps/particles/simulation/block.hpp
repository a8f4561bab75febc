// A cube of space with the particles in it: a chare of a sparse three-dimensional array. The first
// particle that enters creates it, and it ends when a stretch of steps finds it empty. Particles do
// not meet one another, so a block serves locality alone: no result depends on how space is cut.
//
// A stretch is closed by an epoch. Within it particles change blocks; one that has done its steps
// waits among the arrivals until the next stretch, so that none is moved twice.
#pragma once

#include "apps/particles/simulation/flock.hpp"
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

  // For a balancer: blocks that stand side by side have neighbouring positions.
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
