#include "collide/dn_field/step/block_flight.hpp"

#include "collide/dn_field/rules/velocity_rules.hpp"
#include "collide/dn_field/step/sheet_guard.hpp"
#include "collide/dn_field/step/spring_limit.hpp"
#include "collide/dn_field/step/trace.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr int steps_unscreened = 32;     // for which all count as near where screening did not pay
constexpr int spring_rounds = 4;         // in which a particle is put where its energy lets it be
constexpr std::size_t sample_size = 32;  // particles of a block that are screened to see if it pays

/// The speed that a particle away from all surfaces gains in the steps of `changes`, at most.
double speed_gained(const Run& run, std::span<const VelocityChanges> changes) {
  double gained =
      static_cast<double>(changes.size()) * run.plan.step * norm(run.constants.acceleration);
  for (const VelocityChanges& step : changes)
    for (const Kick& kick : step.kicks) gained += std::abs(kick.kick);
  return gained;
}

/// Whether to take the near ones apart for the next `ahead` of `left` steps. The costs are
/// nanoseconds a particle, measured roughly: they decide how fast the result is there, never which.
bool screening_pays(const Stepper::Plan& plan, std::size_t near, std::size_t all, int ahead,
                    int left) {
  if (near == all) return false;
  constexpr double to_screen = 2.4, to_pack = 2, first_look_up = 4, free_step = 0.3;
  const double near_step = (plan.rules.spring || plan.rules.surface_flow ? 8 : 2) +
                           (plan.rules.look_up == LookUp::trilinear ? 12 : 0);
  const double part = static_cast<double>(near) / static_cast<double>(all);
  const double packed =
      (to_screen + part * (to_pack + first_look_up)) / ahead + part * near_step + free_step;
  return packed < near_step + first_look_up / std::min(left, steps_unscreened);
}

/// Each particle's stay in the order of time.
void sort_by_particle(std::vector<Waypoint>& waypoints) {
  std::ranges::stable_sort(waypoints, {}, &Waypoint::particle);
}

}  // namespace

BlockFlight::BlockFlight(bool keeps_waypoints) : keeps_waypoints_(keeps_waypoints) {
  clear(first_, block_size);
  clear(second_, block_size);
}

void BlockFlight::new_particles(std::size_t count) {
  forget(*closest_, count);
  known_ = false;
}

/// `closest_` is what the look-up before found of these particles.
void BlockFlight::look_up_all(const Run& run, std::span<const Placed> objects,
                              const ParticleSpan& particles, Closest& closest) const {
  if (run.setting == Setting::general) clear(closest, particles.count);
  for (const Placed& object : objects) run.look_up(object, particles, *closest_, closest);
}

/// The rules of the surface, for particles that may feel it.
void BlockFlight::meet_surface(const Run& run, const Moments& moments, int step,
                               const ParticleSpan& particles) {
  const Stepper::Plan& plan = run.plan;
  const auto& objects = moments.objects_at(step);
  const auto& sheets = moments.sheets_at(step);
  if (!known_) look_up_all(run, objects, particles, *closest_);
  const Closest& closest = *closest_;
  if (const auto& drag = plan.rules.surface_drag; drag && drag->law == DragLaw::quadratic)
    drag_quadratic(drag->rate * plan.step, drag->threshold, run.setting, particles, closest);
  if (plan.rules.surface_flow) turn_to_surface(run.constants.flow, run.setting, particles, closest);
  scratch_.keeps_waypoints = keeps_waypoints_ || !sheets.empty();
  scratch_.waypoints.clear();
  if (!sheets.empty() || plan.rules.spring) start_.remember(particles);
  run.loop(run.constants, particles, closest, scratch_);
  trace(run.constants, objects, plan.rules.look_up, particles, scratch_);
  Moved moved = Moved::none;
  if (plan.rules.spring) {
    const SpringLimit limit{run.constants, run.setting, closest, start_, scratch_};
    moved = Moved::some;
    for (int round = 0; round <= spring_rounds && moved == Moved::some; ++round) {
      look_up_all(run, moments.objects_at(step + 1), particles, *after_);
      moved = round < spring_rounds ? limit.cut(*after_, particles)
                                    : limit.put_back(*after_, particles);
    }
  }
  sort_by_particle(scratch_.waypoints);
  if (!sheets.empty()) {
    const SheetScene scene{run.constants,
                           sheets,
                           run.setting,
                           closest,
                           plan.sweep == Sweep::on,
                           plan.rules.spring.has_value(),
                           sheets.size() == objects.size()};
    if (keep_off_sheets(scene, start_, scratch_.waypoints, particles) == Moved::some)
      moved = Moved::some;
  }
  if (!plan.rules.spring) return;
  // Objects that do not move say the same at the start of the next step.
  known_ = run.setting == Setting::one_at_rest && moved == Moved::none;
  std::swap(closest_, after_);
}

void BlockFlight::step_near(const Run& run, const Moments& moments, int step,
                            const ParticleSpan& particles) {
  const VelocityChanges& changes = moments.changes_at(step);
  if (!changes.none()) change_velocities(changes, particles);
  meet_surface(moments.run(step, run), moments, step, particles);
}

/// Of waypoints of packed particles.
void BlockFlight::number_in_block() {
  std::erase_if(scratch_.waypoints,
                [&](const Waypoint& bend) { return bend.particle >= near_.count; });
  for (Waypoint& bend : scratch_.waypoints) bend.particle = near_.index[bend.particle];
  sort_by_particle(scratch_.waypoints);
}

bool BlockFlight::screen_for(const Run& run, const Moments& moments, int from, int to,
                             const ParticleSpan& particles) {
  const Stepper::Plan& plan = run.plan;
  screen(moments.objects_at(from), plan.rules.look_up, plan.sweep,
         {static_cast<float>(moments.run(from, run).reach),
          static_cast<float>((to - from) * plan.step),
          static_cast<float>(speed_gained(run, moments.changes_in(from, to))),
          to - from > 1 || plan.rules.spring.has_value()},
         particles, near_);
  return screening_pays(plan, near_.count, particles.count, to - from, moments.n_steps() - from);
}

void BlockFlight::fly(const Run& run, const Moments& moments, const ParticleSpan& block) {
  const FreeLoop fly_free = run.plan.fly_free;
  scratch_.waypoints.clear();
  if (!run.plan.looks_up) return fly_free(run.constants, block, moments.changes);
  const ParticleSpan some = block.part(0, std::min(sample_size, block.count));
  const int n_steps = moments.n_steps();
  int ahead = run.look_ahead;
  bool looked_up = false;  // of the whole block, in the step before
  for (int i = 0; i < n_steps;) {
    int next = std::min(i + ahead, n_steps);
    // Where it did not pay before, a few of the block tell whether to look at the others.
    screening_paid_ = (screening_paid_ || screen_for(run, moments, i, next, some)) &&
                      screen_for(run, moments, i, next, block);
    if (!screening_paid_) {
      ahead = std::max(1, ahead / 2);
      next = std::min(i + steps_unscreened, n_steps);
      if (!looked_up) new_particles(block.count);
      looked_up = true;
      for (; i < next; ++i) step_near(run, moments, i, block);
      continue;
    }
    if (8 * near_.count < block.count) ahead = std::min(run.look_ahead, 2 * ahead);
    looked_up = false;
    pack(block, near_);
    const ParticleSpan packed = near_.packed();
    new_particles(packed.count);
    for (int k = i; k < next && packed.count > 0; ++k) step_near(run, moments, k, packed);
    fly_free(run.constants, block, moments.changes_in(i, next));
    i = next;
    near_.unpack(block);
    if (keeps_waypoints_) number_in_block();
  }
}

}  // namespace tess::dn
