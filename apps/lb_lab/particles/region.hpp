// A block of the plane with its particles: a chare of a sparse array. The first particle that
// enters creates it, on the PE that the particle comes from, and it ends when it is empty at the
// begin of an iteration. A particle that enters has done its iteration, and waits among the
// arrivals.
//
// A Block of apps/particles has the same protocol: arrivals wait for their iteration, an empty
// chare ends, leavers are sent with create-on-demand. These are the 30 lines of enter(), take_in() and
// send_leavers(), and a shared base with its two parameters (particle, context) is not shorter.
#pragma once

#include "apps/lb_lab/particles/swarm.hpp"
#include "apps/lb_lab/run/station.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <vector>

namespace lb_lab {

/// Particles on their way to a region.
struct Arrivals {
  std::int32_t iteration = 0;  ///< their next
  tess::GroupProxy<Station> stations;
  std::vector<Particle> particles;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(iteration, stations, particles);
  }
};

class Region : public tess::Chare<Region, tess::Index2> {
 public:
  // Entry methods.
  void enter(Arrivals arrivals);
  void step(std::int32_t iteration);
  /// Adds the answer of its particles to the station of this PE, and ends.
  void end();

  /// For the balancer.
  [[nodiscard]] std::array<double, 3> balance_position() const {
    return {1.0 * index().x, 1.0 * index().y, 0};
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(stations_, particles_, arrivals_);
  }

 private:
  void take_in(std::int32_t iteration);
  void send_leavers(const Domain& domain, std::int32_t iteration);

  tess::GroupProxy<Station> stations_;
  std::vector<Particle> particles_;
  std::vector<Arrivals> arrivals_;
};

/// The region of a place: the domain's blocks, all of one size.
[[nodiscard]] tess::Index2 region_of(const Domain& domain, const Particle& particle);

}  // namespace lb_lab
