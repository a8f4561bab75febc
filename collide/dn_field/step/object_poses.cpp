#include "collide/dn_field/step/object_poses.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr int furthest_ahead = 16;  // steps that one culling may serve

/// Sets what depends on the size of the objects.
void set_lengths(Run& run, std::span<const Object> objects) {
  const Stepper::Plan& plan = run.plan;
  double coarsest = 0, finest = HUGE_VAL, error = 0;
  for (const Object& object : objects) {
    const double cell = object.frame.scale * object.field->grid.cell;
    coarsest = std::max(coarsest, cell);
    finest = std::min(finest, cell);
    error = std::max(error, object.frame.scale * compression_error(*object.field));
  }
  run.constants.slack =
      (plan.rules.look_up == LookUp::nearest ? 0.5 * std::sqrt(3.0) : 1e-3) * coarsest + error;
  run.constants.stride = run.constants.sunk = 0.5 * finest;
  run.reach = reach(plan.rules) + 1e-3 * finest;
}

}  // namespace

Run run_of(const Stepper::Plan& plan, std::span<const Object> objects) {
  Run run{plan, plan.constants};
  run.look_ahead = furthest_ahead;
  const bool simple =
      objects.size() == 1 && !objects[0].frame.is_moving() && !objects[0].frame.is_turned();
  run.setting = simple || !plan.samples_fields ? Setting::one_at_rest : Setting::general;
  run.sample =
      nearest_pass(plan.rules.look_up, plan.asked, simple ? Setting::one_at_rest : Setting::general,
                   plan.sweep, !objects.empty() && objects[0].field->planes != nullptr);
  run.loop = run.setting == Setting::one_at_rest ? plan.loop_at_rest : plan.loop_general;
  set_lengths(run, objects);
  for (const Object& object : objects)
    if (object.frame.is_growing() || !(jump_of(*object.field) < 4 * object.field->grid.cell))
      run.look_ahead = 1;
  return run;
}

ObjectPoses object_poses(const Run& run, std::vector<Object>& objects, double first, int n_steps) {
  const Stepper::Plan& plan = run.plan;
  const auto any_frame = [&objects](bool (Frame::*is)() const) {
    return std::ranges::any_of(objects, [is](const Object& o) { return (o.frame.*is)(); });
  };
  const bool restless = any_frame(&Frame::is_moving), growing = any_frame(&Frame::is_growing);
  ObjectPoses poses;
  const auto place_objects = [&] {
    auto& now = poses.objects.emplace_back();
    for (const Object& object : objects)
      now.push_back(
          placed(object, plan.rules.look_up, plan.step, restless, plan.constants.threshold));
  };
  for (int i = 0; i < n_steps; ++i) {
    poses.changes.push_back(velocity_changes(plan.rules, (first + i) * plan.step, plan.step));
    if (growing) set_lengths(poses.grown.emplace_back(run), objects);
    place_objects();
    advance(objects, plan.step, 1);
  }
  place_objects();
  return poses;
}

}  // namespace tess::dn
