#include "collide/dn_field/stepper.hpp"

#include "collide/dn_field/spring_limit.hpp"
#include "collide/dn_field/step_plan.hpp"
#include "collide/dn_field/trace.hpp"
#include "collide/dn_field/velocity_rules.hpp"

#include <algorithm>
#include <array>

namespace tess::dn {
namespace {

constexpr int steps_at_once = 64;        // for which the objects' positions are made in advance
constexpr int furthest_ahead = 16;       // steps that one screening may serve
constexpr int steps_unscreened = 32;     // for which all count as near where screening did not pay
constexpr std::size_t sample_size = 32;  // particles of a block that are screened to see if it pays

/// The number of steps since time 0, whole where `time` is meant to be a sum or multiple of steps:
/// then a run from there sees the same times to the bit as one that came by.
double steps_before(double time, double step) {
  const double steps = time / step, whole = std::round(steps);
  return std::abs(steps - whole) < 1e-6 ? whole : steps;
}

/// What a block needs besides its particles; made once a run.
struct Buffers {
  Closest first, second;
  Closest *closest = &first, *after = &second;  ///< at the step's start and end
  bool known = false;                           ///< `closest` is up to date
  Near near;
  bool screening_paid = true;  ///< the last time, whichever block it was
  Scratch scratch;

  void new_particles(std::size_t count) {
    forget(*closest, count);
    known = false;
  }
};

/// What is the same for all blocks of a run.
struct Run {
  const Stepper::Plan& plan;
  RuleConstants constants;
  Setting setting = Setting::general;
  double reach = 0;                 ///< of the rules, and what rounding could hide
  int look_ahead = furthest_ahead;  ///< steps that a screening may serve
  ClosestPass look_up = nullptr;
  RuleLoop loop = nullptr;
};

/// What depends on the size of the objects.
void set_lengths(Run& run, std::span<const Object> objects) {
  const Stepper::Plan& plan = run.plan;
  double coarsest = 0, finest = HUGE_VAL, off = 0;
  for (const Object& object : objects) {
    const double cell = object.frame.scale * object.field->grid.cell;
    coarsest = std::max(coarsest, cell);
    finest = std::min(finest, cell);
    if (object.compressed != nullptr)
      off = std::max(off, object.frame.scale * object.compressed->measured.distance);
  }
  run.constants.slack =
      (plan.rules.look_up == LookUp::nearest ? 0.5 * std::sqrt(3.0) : 1e-3) * coarsest + off;
  run.constants.stride = 0.5 * finest;
  run.reach = reach(plan.rules) + 1e-3 * finest;
}

Run prepared(const Stepper::Plan& plan, std::span<const Object> objects) {
  Run run{plan, plan.constants};
  const bool simple =
      objects.size() == 1 && !objects[0].frame.is_moving() && !objects[0].frame.is_turned();
  run.setting = simple || !plan.looks_up ? Setting::one_at_rest : Setting::general;
  run.look_up = closest_pass(plan.rules.look_up,
                             plan.asked,
                             simple ? Setting::one_at_rest : Setting::general,
                             plan.sweep,
                             storage_of(objects));
  run.loop = run.setting == Setting::one_at_rest ? plan.loop_at_rest : plan.loop_general;
  set_lengths(run, objects);
  for (const Object& object : objects)
    if (object.frame.is_growing() || !(jump_of(object) < 4 * object.field->grid.cell))
      run.look_ahead = 1;
  return run;
}

void look_up_all(const Run& run,
                 std::span<const Placed> objects,
                 const ParticleSpan& particles,
                 const Closest& last,
                 Closest& closest) {
  if (run.setting == Setting::general) clear(closest, particles.count);
  for (const Placed& object : objects) run.look_up(object, particles, last, closest);
}

/// The rules of the surface, for particles that may feel it; the objects as they stand when the
/// step begins and when it ends.
void meet_surface(const Run& run,
                  std::span<const Placed> objects,
                  std::span<const Placed> objects_after,
                  const ParticleSpan& particles,
                  Buffers& buffers) {
  const Stepper::Plan& plan = run.plan;
  Scratch& scratch = buffers.scratch;
  Closest& closest = *buffers.closest;
  if (!buffers.known) look_up_all(run, objects, particles, closest, closest);
  if (const auto& drag = plan.rules.surface_drag; drag && drag->law == DragLaw::quadratic)
    drag_quadratic(drag->rate * plan.step, drag->threshold, run.setting, particles, closest);
  if (plan.rules.surface_flow) turn_to_surface(run.constants.flow, run.setting, particles, closest);
  run.loop(run.constants, particles, closest, scratch);
  trace(run.constants, objects, plan.rules.look_up, scratch.untraced, particles, scratch.energy);
  scratch.untraced.clear();
  if (!plan.rules.spring) return;
  look_up_all(run, objects_after, particles, closest, *buffers.after);
  const Moved moved =
      limit_spring(run.constants.spring, run.setting, particles, closest, *buffers.after, scratch);
  // Objects that do not move say the same at the start of the next step.
  buffers.known = run.setting == Setting::one_at_rest && moved == Moved::none;
  std::swap(buffers.closest, buffers.after);
}

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
bool screening_pays(
    const Stepper::Plan& plan, std::size_t near, std::size_t all, int ahead, int left) {
  if (near == all) return false;
  constexpr double to_screen = 2.4, to_pack = 2, first_look_up = 4, free_step = 0.3;
  const double near_step = (plan.rules.spring || plan.rules.surface_flow ? 8 : 2) +
                           (plan.rules.look_up == LookUp::trilinear ? 12 : 0);
  const double part = static_cast<double>(near) / static_cast<double>(all);
  const double packed =
      (to_screen + part * (to_pack + first_look_up)) / ahead + part * near_step + free_step;
  return packed < near_step + first_look_up / std::min(left, steps_unscreened);
}

/// The next steps of a run: what acts and where objects stand at each, and what depends on their
/// size.
struct Moments {
  std::vector<VelocityChanges> changes;
  std::vector<std::vector<Placed>> objects;  ///< and when the last step ends
  std::vector<Run> grown;                    ///< empty where no object grows

  [[nodiscard]] const Run& run(std::size_t i, const Run& all) const {
    return grown.empty() ? all : grown[i];
  }
};

/// n_steps from `first` steps after time 0 on. The objects are left where they stand after them.
Moments moments_of(const Run& run, std::vector<Object>& objects, double first, int n_steps) {
  const Stepper::Plan& plan = run.plan;
  bool restless = false, growing = false;
  for (const Object& object : objects) {
    restless = restless || object.frame.is_moving();
    growing = growing || object.frame.is_growing();
  }
  Moments result;
  for (int i = 0; i < n_steps; ++i)
    result.changes.push_back(velocity_changes(plan.rules, (first + i) * plan.step, plan.step));
  const auto stand = [&] {
    auto& now = result.objects.emplace_back();
    now.reserve(objects.size());
    for (const Object& object : objects)
      now.push_back(placed(object, plan.rules.look_up, plan.step, restless));
  };
  for (int i = 0; i < n_steps; ++i) {
    if (growing) set_lengths(result.grown.emplace_back(run), objects);
    stand();
    advance(objects, plan.step, 1);
  }
  stand();
  return result;
}

/// Takes one block through the steps of `moments`.
/// Who may feel a surface in the next few steps is packed and taken through them alone, the others
/// fly free; where not enough fly free to pay for that, all are taken as near.
void fly(const Run& run, const Moments& moments, const ParticleSpan& block, Buffers& buffers) {
  const Stepper::Plan& plan = run.plan;
  const int n_steps = static_cast<int>(moments.changes.size());
  const auto run_at = [&](int i) -> const Run& {
    return moments.run(static_cast<std::size_t>(i), run);
  };
  const auto objects_at = [&](int i) -> const std::vector<Placed>& {
    return moments.objects[static_cast<std::size_t>(i)];
  };
  Near& near = buffers.near;
  const auto changes = [&](int from, int to) {
    return std::span(moments.changes)
        .subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(to - from));
  };
  const auto step_near = [&](int i, const ParticleSpan& particles) {
    const VelocityChanges& now = moments.changes[static_cast<std::size_t>(i)];
    if (!now.none()) change_velocities(now, particles);
    meet_surface(run_at(i), objects_at(i), objects_at(i + 1), particles, buffers);
  };
  if (!plan.looks_up) return plan.fly_free(run.constants, block, moments.changes);
  int i = 0;
  int ahead = run.look_ahead;
  bool looked_up = false;  // of the whole block, in the step before
  while (i < n_steps) {
    int next = std::min(i + ahead, n_steps);
    const double gained = speed_gained(run, changes(i, next));
    const auto screening_of = [&](const ParticleSpan& particles) {
      screen(objects_at(i),
             plan.rules.look_up,
             plan.sweep,
             {static_cast<float>(run_at(i).reach),
              static_cast<float>((next - i) * plan.step),
              static_cast<float>(gained),
              next - i > 1 || plan.rules.spring.has_value()},
             particles,
             near);
      return screening_pays(plan, near.count, particles.count, next - i, n_steps - i);
    };
    // Where it did not pay before, a few of the block tell whether to look at the others.
    const bool pays = (buffers.screening_paid ||
                       screening_of(block.part(0, std::min(sample_size, block.count)))) &&
                      screening_of(block);
    buffers.screening_paid = pays;
    if (!pays) {
      ahead = std::max(1, ahead / 2);
      next = std::min(i + steps_unscreened, n_steps);
      if (!looked_up) buffers.new_particles(block.count);
      looked_up = true;
      for (; i < next; ++i) step_near(i, block);
      continue;
    }
    if (8 * near.count < block.count) ahead = std::min(run.look_ahead, 2 * ahead);
    looked_up = false;
    pack(block, near);
    const ParticleSpan packed = near.packed();
    buffers.new_particles(packed.count);
    for (int k = i; k < next && packed.count > 0; ++k) step_near(k, packed);
    plan.fly_free(run.constants, block, changes(i, next));
    i = next;
    near.unpack(block);
  }
}

}  // namespace

void Stepper::run(ParticleSpan particles,
                  std::span<const Object> objects,
                  double time,
                  int n_steps) const {
  const Plan& plan = *plan_;
  const Run run = prepared(plan, objects);
  std::vector<Object> standing(objects.begin(), objects.end());
  if (!plan.looks_up) standing.clear();
  const double before = steps_before(time, plan.step);
  const auto buffers = std::make_unique<Buffers>();
  clear(buffers->first, block_size);
  clear(buffers->second, block_size);
  // The last particles, fewer than a vector, are stepped in room of their own.
  const std::size_t whole = particles.count / lanes::width * lanes::width;
  std::array<std::array<double, lanes::width>, 6> room{};
  const ParticleSpan rest{room[0].data(),
                          room[1].data(),
                          room[2].data(),
                          room[3].data(),
                          room[4].data(),
                          room[5].data(),
                          lanes::width};
  const auto copy = [&](bool in) {
    const std::array<double*, 6> outer{
        particles.x, particles.y, particles.z, particles.vx, particles.vy, particles.vz};
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t i = 0; whole + i < particles.count; ++i)
        if (in)
          room[a][i] = outer[a][whole + i];
        else
          outer[a][whole + i] = room[a][i];
  };
  copy(true);
  for (int done = 0; done < n_steps; done += steps_at_once) {
    const int now = std::min(steps_at_once, n_steps - done);
    const Moments moments = moments_of(run, standing, before + done, now);
    const auto step_all = [&](const ParticleSpan& block) { fly(run, moments, block, *buffers); };
    for (std::size_t first = 0; first < whole; first += block_size)
      step_all(particles.part(first, std::min(block_size, whole - first)));
    if (whole < particles.count) step_all(rest);
  }
  copy(false);
}

const Rules& Stepper::rules() const {
  return plan_->rules;
}
double Stepper::step() const {
  return plan_->step;
}

}  // namespace tess::dn
