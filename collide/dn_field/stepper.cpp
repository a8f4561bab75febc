#include "collide/dn_field/stepper.hpp"

#include "collide/dn_field/spring_limit.hpp"
#include "collide/dn_field/step_plan.hpp"
#include "collide/dn_field/trace.hpp"
#include "collide/dn_field/velocity_rules.hpp"

#include <algorithm>
#include <array>

namespace tess::dn {
namespace {

constexpr int steps_unscreened = 7;  // of a block whose particles were mostly near
constexpr int steps_at_once = 64;    // for which the objects' positions are made in advance

/// The number of steps since time 0, whole where `time` is meant to be a sum or multiple of steps:
/// then a run from there sees the same times to the bit as one that came by.
double steps_before(double time, double step) {
  const double steps = time / step, whole = std::round(steps);
  return std::abs(steps - whole) < 1e-6 ? whole : steps;
}

/// What a block needs besides its particles; made once a run.
struct Buffers {
  Closest closest, after;
  Near near;
  Scratch scratch;
};

/// What is the same for all blocks of a run.
struct Run {
  const Stepper::Plan& plan;
  RuleConstants constants;
  Setting setting = Setting::general;
  Reach reach;
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
  // Moved outward by what rounding could hide.
  const RuleConstants& c = run.constants;
  const double added = plan.step * std::max(c.air.gain, c.surface.gain) * norm(c.acceleration);
  run.reach = {static_cast<float>(reach(plan.rules) + added + 1e-3 * finest),
               static_cast<float>(plan.step)};
}

Run prepared(const Stepper::Plan& plan, std::span<const Object> objects) {
  Run run{plan, plan.constants, Setting::general, {}, nullptr, nullptr};
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
  return run;
}

/// The rules of the surface, for particles that may feel it.
void meet_surface(const Run& run,
                  std::span<const Placed> objects,
                  const ParticleSpan& particles,
                  Buffers& buffers) {
  const Stepper::Plan& plan = run.plan;
  auto& [closest, after, near, scratch] = buffers;
  if (run.setting == Setting::general) clear(closest, particles.count);
  for (const Placed& object : objects) run.look_up(object, particles, closest);
  if (const auto& drag = plan.rules.surface_drag; drag && drag->law == DragLaw::quadratic)
    drag_quadratic(drag->rate * plan.step, drag->threshold, run.setting, particles, closest);
  run.loop(run.constants, particles, closest, scratch);
  for (const Untraced& from : scratch.untraced)
    scratch.energy[from.particle] +=
        trace(run.constants, objects, plan.rules.look_up, from, particles);
  scratch.untraced.clear();
  if (plan.rules.spring) {
    if (run.setting == Setting::general) clear(after, particles.count);
    for (const Placed& object : objects) run.look_up(object, particles, after);
    limit_spring(run.constants.spring, run.setting, particles, closest, after, scratch);
  }
}

void one_step(const Run& run,
              std::span<const Placed> objects,
              double time,
              const ParticleSpan& block,
              Buffers& buffers) {
  const Stepper::Plan& plan = run.plan;
  for (const Explosion& explosion : plan.rules.explosions)
    if (const double active = active_within(explosion, time, plan.step); active > 0)
      explode(explosion, active, block);
  if (plan.rules.air_drag && plan.rules.air_drag->law == DragLaw::quadratic)
    drag_quadratic(plan.rules.air_drag->rate * plan.step, block);
  Near& near = buffers.near;
  near.count = 0;
  if (plan.looks_up) {
    if (near.unscreened > 0) {
      --near.unscreened;
      return meet_surface(run, objects, block, buffers);
    }
    screen(objects, plan.rules.look_up, plan.sweep, run.reach, block, near);
    // Packing pays where few are near, and screening where not most are. The bound that lets others
    // stay is exact for the look-ups of one voxel, so that they come out the same either way.
    const bool most = plan.rules.look_up != LookUp::trilinear && 2 * near.count > block.count;
    if (most) near.unscreened = steps_unscreened;
    if (most || near.count == block.count) return meet_surface(run, objects, block, buffers);
    pack(block, near);
  }
  plan.loop_without(run.constants, block, buffers.closest, buffers.scratch);
  if (near.count == 0) return;
  meet_surface(run, objects, near.packed(), buffers);
  near.unpack(block);
}

/// The next steps of a run: where objects stand at each, and what depends on their size.
struct Moments {
  std::vector<std::vector<Placed>> objects;
  std::vector<Run> grown;  ///< empty where no object grows

  [[nodiscard]] const Run& run(std::size_t i, const Run& all) const {
    return grown.empty() ? all : grown[i];
  }
};

/// The objects are left where they stand after the steps.
Moments moments_of(const Run& run, std::vector<Object>& objects, int n_steps) {
  const Stepper::Plan& plan = run.plan;
  bool restless = false, growing = false;
  for (const Object& object : objects) {
    restless = restless || object.frame.is_moving();
    growing = growing || object.frame.is_growing();
  }
  Moments result;
  result.objects.resize(static_cast<std::size_t>(n_steps));
  for (auto& now : result.objects) {
    if (growing) set_lengths(result.grown.emplace_back(run), objects);
    now.reserve(objects.size());
    for (const Object& object : objects)
      now.push_back(placed(object, plan.rules.look_up, plan.step, restless));
    advance(objects, plan.step, 1);
  }
  return result;
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
  clear(buffers->closest, block_size);
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
    const Moments moments = moments_of(run, standing, now);
    const auto step_all = [&](const ParticleSpan& block) {
      buffers->near.unscreened = 0;
      for (int i = 0; i < now; ++i) {
        const auto at = static_cast<std::size_t>(i);
        one_step(moments.run(at, run),
                 moments.objects[at],
                 (before + done + i) * plan.step,
                 block,
                 *buffers);
      }
    };
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
