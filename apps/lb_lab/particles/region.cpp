#include "apps/lb_lab/particles/region.hpp"

#include "runtime/more/monitor.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <algorithm>
#include <utility>

namespace lb_lab {

tess::Index2 region_of(const Domain& domain, const Particle& particle) {
  return {static_cast<std::int32_t>(particle.x * domain.columns / domain.width),
          static_cast<std::int32_t>(particle.y * domain.rows / domain.height)};
}

void Region::enter(Arrivals arrivals) {
  stations_ = arrivals.stations;
  arrivals_.push_back(std::move(arrivals));
}

void Region::take_in(std::int32_t iteration) {
  for (const Arrivals& one : arrivals_)
    if (one.iteration == iteration)
      particles_.insert(particles_.end(), one.particles.begin(), one.particles.end());
  std::erase_if(arrivals_, [=](const Arrivals& one) { return one.iteration == iteration; });
}

void Region::step(std::int32_t iteration) {
  take_in(iteration);
  const Domain& domain = stations_.local().plan().problem.domain;
  tess::show_pixel("particles of each block", domain.columns, domain.rows, index().x, index().y,
                   static_cast<double>(particles_.size()));
  if (particles_.empty()) {
    if (arrivals_.empty()) destroy();
    return;
  }
  Station& here = stations_.local();
  const Problem& problem = here.plan().problem;
  const Swarm swarm(problem);
  const double began = here.cpu();
  swarm.advance(particles_, iteration);
  here.worked(here.cpu() - began, static_cast<double>(particles_.size()) * swarm.seconds());
  send_leavers(problem.domain, iteration);
}

void Region::send_leavers(const Domain& domain, std::int32_t iteration) {
  const auto leaves = [&](const Particle& p) { return region_of(domain, p) != index(); };
  const auto first = std::partition(particles_.begin(), particles_.end(),
                                    [&](const Particle& p) { return !leaves(p); });
  boost::unordered_flat_map<std::int32_t, Arrivals> leaving;  // by the block's number
  for (auto p = first; p != particles_.end(); ++p) {
    const tess::Index2 to = region_of(domain, *p);
    leaving[to.y * domain.columns + to.x].particles.push_back(*p);
  }
  particles_.erase(first, particles_.end());
  for (auto& [to, arrivals] : leaving) {
    arrivals.iteration = iteration + 1;
    arrivals.stations = stations_;
    array()[{to % domain.columns, to / domain.columns}].send_or_create_here<&Region::enter>(
        std::move(arrivals));
  }
}

void Region::end() {
  Station& here = stations_.local();
  for (const Arrivals& arrivals : arrivals_)
    for (const Particle& particle : arrivals.particles) here.take(Swarm::answer(particle));
  for (const Particle& particle : particles_) here.take(Swarm::answer(particle));
  destroy();
}

}  // namespace lb_lab
