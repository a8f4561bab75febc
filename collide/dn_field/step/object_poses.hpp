// What all blocks of particles share in the next steps: the loops that serve these objects, the
// changes of velocity, and where the objects are at each step. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/rule_loop.hpp"
#include "collide/dn_field/stepper.hpp"

namespace tess::dn {

/// What make_stepper() computes once for a scene: the constants of its rules and the loops that
/// hold them.
struct Stepper::Plan {
  Rules rules;
  double step = 0;
  RuleConstants constants;
  bool samples_fields = false;
  Sweep sweep = Sweep::off;
  Ask asked = Ask::both;
  RuleLoop loop_at_rest = nullptr, loop_general = nullptr;
  FreeLoop fly_free = nullptr;
};

/// A plan together with objects.
struct Run {
  const Stepper::Plan& plan;
  RuleConstants constants;
  Setting setting = Setting::general;
  double reach = 0;    ///< distance at which the first rule acts, with room for rounding
  int look_ahead = 0;  ///< steps that one culling may serve
  NearestPass sample = nullptr;
  RuleLoop loop = nullptr;
};

[[nodiscard]] Run run_of(const Stepper::Plan& plan, std::span<const Object> objects);

/// The next steps of a run.
struct ObjectPoses {
  std::vector<VelocityChanges> changes;            ///< of each step
  std::vector<std::vector<PlacedObject>> objects;  ///< at each step's start, and at the last end
  std::vector<Run> grown;                          ///< of each step; empty if no object grows

  [[nodiscard]] int n_steps() const { return static_cast<int>(changes.size()); }
  [[nodiscard]] const Run& run(int step, const Run& all) const {
    return grown.empty() ? all : grown[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] const std::vector<PlacedObject>& objects_at(int step) const {
    return objects[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] std::span<const VelocityChanges> changes_in(int from, int to) const {
    return std::span(changes).subspan(static_cast<std::size_t>(from),
                                      static_cast<std::size_t>(to - from));
  }
};

/// n_steps steps, the first of which starts `first` steps after time 0. Advances `objects` to the
/// end of the last one.
[[nodiscard]] ObjectPoses object_poses(const Run& run, std::vector<Object>& objects, double first,
                                       int n_steps);

}  // namespace tess::dn
