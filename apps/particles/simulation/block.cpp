#include "apps/particles/simulation/block.hpp"

#include "runtime/core/cpu_clock.hpp"
#include "runtime/more/monitor.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace particles {
namespace {

/// Whether any particle is outside of the box: one pass without branches, since usually none is.
bool any_outside(const tess::dn::Particles& motion, const tess::dn::Bounds& box) {
  const auto& [low, high] = box;
  const auto is_within = [](double at, double least, double most) {
    return static_cast<std::size_t>(at >= least) & static_cast<std::size_t>(at < most);
  };
  std::size_t n_within = 0;
  for (std::size_t p = 0; p < motion.size(); ++p)
    n_within += is_within(motion.x[p], low.x, high.x) & is_within(motion.y[p], low.y, high.y) &
                is_within(motion.z[p], low.z, high.z);
  return n_within != motion.size();
}

}  // namespace

void Block::enter(Arrivals arrivals) {
  stations_ = arrivals.stations;
  arrivals_.push_back(std::move(arrivals));
}

void Block::take_in(std::int32_t step) {
  for (Arrivals& arrivals : arrivals_) {
    if (arrivals.step != step) continue;
    flocks_.resize(std::max(flocks_.size(), arrivals.flocks.size()));
    for (std::size_t s = 0; s < arrivals.flocks.size(); ++s)
      for (std::size_t p = 0; p < arrivals.flocks[s].size(); ++p)
        flocks_[s].add(arrivals.flocks[s], p);
  }
  std::erase_if(arrivals_, [step](const Arrivals& arrivals) { return arrivals.step == step; });
}

void Block::move(const Stretch& stretch) {
  take_in(stretch.first);
  std::size_t n_particles = 0;
  for (const Flock& flock : flocks_) n_particles += flock.size();
  const Space& space = stations_.local().space();
  const tess::Index3 &from = space.first, &to = space.last, &here = index();
  const std::int64_t columns = to.x - from.x + 2;  // one between two layers
  tess::show_pixel("particles of each block, layer by layer", columns * (to.z - from.z + 1) - 1,
                   to.y - from.y + 1, columns * (here.z - from.z) + here.x - from.x,
                   here.y - from.y, static_cast<double>(n_particles));
  if (n_particles == 0 && arrivals_.empty()) {
    destroy();
    return;
  }
  if (n_particles != 0) work(stretch);
}

void Block::work(const Stretch& stretch) {
  Station& station = stations_.local();
  for (std::size_t s = 0; s < flocks_.size(); ++s) advance(s, stretch, station);
  if (stretch.ask != Stretch::nothing) look(stretch, station);
  send_leavers(stretch.first + stretch.n_steps, station);
}

void Block::advance(std::size_t species, const Stretch& stretch, Station& station) {
  Flock& flock = flocks_[species];
  if (stretch.n_steps == 0 || flock.size() == 0) return;
  const tess::dn::Stepper& stepper = station.stepper(species);
  if (station.stage().species[species].audited) {
    advance_audited(flock, stepper, stretch, station);
    return;
  }
  const double begin = tess::thread_cpu_seconds();
  stepper.run(flock.motion.span(), station.objects(stretch.first),
              stretch.first * station.stage().scene.dt, stretch.n_steps);
  station.spent().rules += tess::thread_cpu_seconds() - begin;
}

void Block::advance_audited(Flock& flock, const tess::dn::Stepper& stepper, const Stretch& stretch,
                            Station& station) {
  const Stage& stage = station.stage();
  const double dt = stage.scene.dt;
  std::vector<tess::dn::Object> objects = station.objects(stretch.first);
  for (std::int32_t step = stretch.first; step < stretch.first + stretch.n_steps; ++step) {
    const double begin = tess::thread_cpu_seconds();
    const tess::dn::Particles before = flock.motion;
    const std::vector<tess::dn::Waypoint> waypoints =
        stepper.run_once(flock.motion.span(), objects, step * dt);
    const double moved = tess::thread_cpu_seconds();
    note_tunnelled(stage, objects, before, waypoints, flock);
    tess::dn::advance(objects, dt, 1);
    station.spent().rules += moved - begin;
    station.spent().audit += tess::thread_cpu_seconds() - moved;
  }
}

void Block::look(const Stretch& stretch, Station& station) {
  const Stage& stage = station.stage();
  std::vector<tess::dn::Object> objects = station.objects(stretch.first);
  tess::dn::advance(objects, stage.scene.dt, stretch.n_steps);
  const bool measures = (stretch.ask & Stretch::measure) != 0;
  if (measures) ++station.measured().blocks;
  for (std::size_t s = 0; s < flocks_.size(); ++s) {
    const Species& species = stage.species[s];
    if ((stretch.ask & Stretch::judge) != 0 && !species.audited)
      note_inside(stage, objects, flocks_[s]);
    if (measures) measure(stage, objects, flocks_[s], species.mass, station.measured());
    if ((stretch.ask & Stretch::trace) != 0) trace(stage, flocks_[s], station.samples());
  }
}

void Block::send_leavers(std::int32_t step, Station& station) {
  const Space& space = station.space();
  const tess::dn::Bounds box = space.box(index());
  std::map<tess::Index3, Arrivals> leaving;
  for (std::size_t s = 0; s < flocks_.size(); ++s) {
    Flock& flock = flocks_[s];
    if (!any_outside(flock.motion, box)) continue;
    for (std::size_t p = flock.size(); p-- > 0;) {
      const tess::Index3 to = space.block_of(flock.motion.position(p));
      if (to == index()) continue;
      Arrivals& arrivals = leaving[to];
      arrivals.flocks.resize(flocks_.size());
      arrivals.flocks[s].add(flock, p);
      flock.remove(p);
    }
  }
  for (auto& [to, arrivals] : leaving) {
    arrivals.step = step;
    arrivals.stations = stations_;
    array()[to].send_or_create_here<&Block::enter>(std::move(arrivals));
  }
}

}  // namespace particles
