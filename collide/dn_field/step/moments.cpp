#include "collide/dn_field/step/moments.hpp"

#include "collide/dn_field/rules/velocity_rules.hpp"

#include <algorithm>
#include <iterator>

namespace tess::dn {
namespace {
constexpr int furthest_ahead = 16;  // steps that one screening may serve

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
  run.constants.stride = run.constants.sunk = 0.5 * finest;
  run.reach = reach(plan.rules) + 1e-3 * finest;
}

}  // namespace

Run run_of(const Stepper::Plan& plan, std::span<const Object> objects) {
  Run run{plan, plan.constants};
  run.look_ahead = furthest_ahead;
  const bool simple =
      objects.size() == 1 && !objects[0].frame.is_moving() && !objects[0].frame.is_turned();
  run.setting = simple || !plan.looks_up ? Setting::one_at_rest : Setting::general;
  run.look_up =
      closest_pass(plan.rules.look_up, plan.asked, simple ? Setting::one_at_rest : Setting::general,
                   plan.sweep, storage_of(objects));
  run.loop = run.setting == Setting::one_at_rest ? plan.loop_at_rest : plan.loop_general;
  set_lengths(run, objects);
  for (const Object& object : objects)
    if (object.frame.is_growing() || !(jump_of(object) < 4 * object.field->grid.cell))
      run.look_ahead = 1;
  return run;
}

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
    auto& sheets = result.sheets.emplace_back();
    if (plan.rules.impact)
      std::ranges::copy_if(objects, std::back_inserter(sheets), [](const Object& object) {
        return object.triangles != nullptr && object.field->sides == Sides::two;
      });
    advance(objects, plan.step, 1);
  }
  stand();
  return result;
}

}  // namespace tess::dn
