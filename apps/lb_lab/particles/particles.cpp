// The kind of workload in which the chares are regions of space with their particles (region.hpp).
#include "apps/lb_lab/particles/region.hpp"
#include "apps/lb_lab/run/kind.hpp"
#include "apps/lb_lab/run/stepped.hpp"

#include <fmt/format.h>
#include <map>

namespace lb_lab {
namespace {

/// On each PE, for a moment: makes its strip of the plane's particles.
class Source : public tess::Group<Source> {
 public:
  Source(tess::GroupProxy<Station> stations, tess::ArrayProxy<Region> regions) {
    const Problem& problem = stations.local().plan().problem;
    const Swarm swarm(problem);
    const auto n_pes = static_cast<std::uint64_t>(tess::n_pes());
    const auto me = static_cast<std::uint64_t>(pe().value);
    std::map<tess::Index2, Arrivals> strip;
    for (std::uint64_t i = me * swarm.size() / n_pes; i < (me + 1) * swarm.size() / n_pes; ++i) {
      const Particle particle = swarm.first(i);
      strip[region_of(problem.domain, particle)].particles.push_back(particle);
    }
    for (auto& [to, arrivals] : strip) {
      arrivals.stations = stations;
      regions[to].send_or_create_here<&Region::enter>(std::move(arrivals));
    }
  }
};

class Particles final : public Stepped {
 public:
  using Stepped::Stepped;

  tess::BalancerProxy create() override {
    regions_ = tess::create<Region>(tess::sparse);
    return balances(experiment_) ? start_balancing(regions_, experiment_, outcome_)
                                 : tess::BalancerProxy();
  }
  tess::Task begin() override {
    co_await tess::epoch([this] { tess::create<Source>(tess::each_pe, stations_, regions_); });
  }
  tess::Task step(std::int32_t iteration) override {
    co_await tess::epoch([&] { regions_.broadcast<&Region::step>(iteration); });
  }
  tess::Task end() override {
    co_await tess::epoch([this] { regions_.broadcast<&Region::end>(); });
  }

 private:
  tess::ArrayProxy<Region> regions_;
};

std::uint64_t serial_answer_of_particles(const Problem& p) {
  const Swarm swarm(p);
  std::vector<Particle> all;
  for (std::uint64_t i = 0; i < swarm.size(); ++i) all.push_back(swarm.first(i));
  for (std::int32_t t = 0; t < p.n_iterations; ++t) swarm.advance(all, t);
  std::uint64_t answer = 0;
  for (const Particle& particle : all) answer += Swarm::answer(particle);
  return answer;
}

std::string describe_particles(const Problem& p) {
  return fmt::format(
      "{} particles on {} x {} cells, in blocks made on demand; those that leave go to the next "
      "block; slower PEs do extra work instead",
      Swarm(p).size(), p.domain.width, p.domain.height);
}

}  // namespace

const Kind particles_kind{Speeds::relative, &serial_answer_of_particles, &nominal_seconds,
                          &describe_particles, &run_stepped<Particles>};

}  // namespace lb_lab
