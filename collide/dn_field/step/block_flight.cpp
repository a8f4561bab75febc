#include "collide/dn_field/step/block_flight.hpp"

#include "collide/dn_field/step/continuous_collision.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
using namespace lanes;

constexpr double noise = 1e-6;             // of the energy: the rounding of float distances
constexpr int steps_without_culling = 32;  // after culling did not pay
constexpr std::size_t sample_size = 32;    // particles of a block that show whether culling pays

/// Upper bound of the speed that a particle away from all surfaces gains in the steps of `changes`.
double speed_gained(const Run& run, std::span<const VelocityChanges> changes) {
  double gained =
      static_cast<double>(changes.size()) * run.plan.step * norm(run.constants.acceleration);
  for (const VelocityChanges& step : changes)
    for (const Kick& kick : step.kicks) gained += std::abs(kick.kick);
  return gained;
}

/// Whether to separate the near particles for the next `ahead` of `left` steps. Costs are rough
/// measurements in nanoseconds a particle; they decide the run time, never the result.
bool culling_pays(const Stepper::Plan& plan, std::size_t near, std::size_t all, int ahead,
                  int left) {
  if (near == all) return false;
  constexpr double to_cull = 2.4, to_pack = 2, first_sample = 4, free_step = 0.3;
  const double near_step = (plan.rules.spring || plan.rules.surface_flow ? 8 : 2) +
                           (plan.rules.look_up == LookUp::trilinear ? 12 : 0);
  const double part = static_cast<double>(near) / static_cast<double>(all);
  const double packed =
      (to_cull + part * (to_pack + first_sample)) / ahead + part * near_step + free_step;
  return packed < near_step + first_sample / std::min(left, steps_without_culling);
}

}  // namespace

BlockFlight::BlockFlight(bool keeps_waypoints) : keeps_waypoints_(keeps_waypoints) {
  clear(first_, block_size);
  clear(second_, block_size);
}

void BlockFlight::new_particles(std::size_t count) {
  forget(*nearest_, count);
  up_to_date_ = false;
}

/// `nearest_` holds the previous samples of these particles.
void BlockFlight::sample_all(const Run& run, std::span<const PlacedObject> objects,
                             const ParticleSpan& particles, NearestSurface& nearest) const {
  if (run.setting == Setting::general) clear(nearest, particles.count);
  for (const PlacedObject& object : objects) run.sample(object, particles, *nearest_, nearest);
}

/// The correction of springs after the rules of the surface, for particles that one voxel's plane
/// misleads: in a corner, past an edge or on a curved object a particle can enter a stiff spring
/// from the side and would gain potential energy. after_ has the depth at the end of the step. A
/// particle with more energy than it had loses speed; if its depth by itself takes more, it
/// returns: it is put back to its start, which moved with the surface, with reversed velocity
/// relative to the surface. Returns whether a particle did.
bool BlockFlight::limit_springs(const Run& run, const ParticleSpan& span) {
  const SpringConstants spring = run.constants.spring;  // copies that no store can change
  const ParticleSpan particles = span, start = start_.span(span.count);
  bool returned = false;
  for (std::size_t p = 0; p < particles.count; p += width) {
    const D depth = spring.reach - to_double(load<F>(after_->distance + p));
    D3 u{};
    if (run.setting == Setting::general) u = surface_velocities(*nearest_, p);
    const D3 v = velocities(particles, p), w = v - u;
    const D kinetic = dot(w, w), had = max(load<D>(scratch_.energy + p), D{}),
            left = had - spring.stiffness * depth * depth;
    const L over = (depth > 0.0) & (kinetic - left > noise * had) & (kinetic < HUGE_VAL);
    if (!any(over)) continue;
    const L slows = over & (left > 0.0), returns = over & ~slows;
    set_velocities(particles, p, select(slows, u + sqrt(only(slows, left / kinetic)) * w, v));
    if (!any(returns)) continue;
    returned = true;
    const D3 back = fma(all(run.constants.step), u, places(start, p)),
             turned = u + (u - velocities(start, p));
    set_places(particles, p, select(returns, back, places(particles, p)));
    set_velocities(particles, p, select(returns, turned, velocities(particles, p)));
    std::erase_if(scratch_.waypoints, [&](const Waypoint& bend) {
      return bend.particle - p < width && returns[bend.particle - p] != 0;
    });
  }
  return returned;
}

/// The rules of the surface and the flight.
void BlockFlight::meet_surface(const Run& run, const ObjectPoses& poses, int step,
                               const ParticleSpan& particles) {
  const Stepper::Plan& plan = run.plan;
  const auto& objects = poses.objects_at(step);
  if (!up_to_date_) sample_all(run, objects, particles, *nearest_);
  const NearestSurface& nearest = *nearest_;
  if (plan.rules.surface_flow) turn_to_surface(run.constants.flow, run.setting, particles, nearest);
  if (plan.rules.spring) copy(particles, start_.span(particles.count));
  run.loop(run.constants, particles, nearest, scratch_);
  trace(run.constants, objects, plan.rules.look_up, particles, scratch_);
  up_to_date_ = false;
  if (!plan.rules.spring) return;
  sample_all(run, poses.objects_at(step + 1), particles, *after_);
  const bool returned = limit_springs(run, particles);
  // The samples at the end serve the next step where nothing has moved since.
  up_to_date_ = run.setting == Setting::one_at_rest && !returned;
  std::swap(nearest_, after_);
}

void BlockFlight::step_near(const Run& run, const ObjectPoses& poses, int step,
                            const ParticleSpan& particles) {
  const VelocityChanges& changes = poses.changes[static_cast<std::size_t>(step)];
  scratch_.keeps_waypoints = keeps_waypoints_;
  scratch_.waypoints.clear();
  change_velocities_before(changes, particles);
  meet_surface(poses.run(step, run), poses, step, particles);
  change_velocities_after(changes, particles);
}

/// Lists the near particles for the steps from `from` on, before `to`. Returns whether to separate
/// them.
bool BlockFlight::cull_for(const Run& run, const ObjectPoses& poses, int from, int to,
                           const ParticleSpan& particles) {
  const Stepper::Plan& plan = run.plan;
  cull(poses.objects_at(from), plan.rules.look_up, plan.sweep,
       {static_cast<float>(poses.run(from, run).reach), static_cast<float>((to - from) * plan.step),
        static_cast<float>(speed_gained(run, poses.changes_in(from, to))),
        to - from > 1 || plan.rules.spring.has_value()},
       particles, near_);
  return culling_pays(plan, near_.count, particles.count, to - from, poses.n_steps() - from);
}

void BlockFlight::fly(const Run& run, const ObjectPoses& poses, const ParticleSpan& block) {
  const FreeLoop fly_free = run.plan.fly_free;
  scratch_.waypoints.clear();
  if (!run.plan.samples_fields) return fly_free(run.constants, block, poses.changes);
  const ParticleSpan some = block.part(0, std::min(sample_size, block.count));
  const int n_steps = poses.n_steps();
  int ahead = run.look_ahead;
  bool whole_block = false;  // the step before took all particles as near
  for (int i = 0; i < n_steps;) {
    int next = std::min(i + ahead, n_steps);
    // Where culling did not pay, a sample of the block decides whether to try again.
    culling_paid_ = (culling_paid_ || cull_for(run, poses, i, next, some)) &&
                    cull_for(run, poses, i, next, block);
    if (!culling_paid_) {
      ahead = std::max(1, ahead / 2);
      next = std::min(i + steps_without_culling, n_steps);
      if (!whole_block) new_particles(block.count);
      whole_block = true;
      for (; i < next; ++i) step_near(run, poses, i, block);
      continue;
    }
    if (8 * near_.count < block.count) ahead = std::min(run.look_ahead, 2 * ahead);
    whole_block = false;
    const ParticleSpan packed = near_.pack(block);
    new_particles(packed.count);
    for (int k = i; k < next && packed.count > 0; ++k) step_near(run, poses, k, packed);
    fly_free(run.constants, block, poses.changes_in(i, next));
    i = next;
    near_.unpack(block);
    // Waypoints get the particles' numbers in the block; those that only fill up a vector have
    // none.
    std::erase_if(scratch_.waypoints,
                  [&](const auto& bend) { return bend.particle >= near_.count; });
    for (Waypoint& bend : scratch_.waypoints) bend.particle = near_.index[bend.particle];
  }
  // Those of one particle stay in the order of time.
  std::ranges::stable_sort(scratch_.waypoints, {}, &Waypoint::particle);
}

}  // namespace tess::dn
