// What is the same for all blocks of particles in the next steps: the loops that serve these
// objects, what acts and where the objects stand at each step. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/closest.hpp"
#include "collide/dn_field/step/step_plan.hpp"

#include <vector>

namespace tess::dn {

/// A plan together with objects.
struct Run {
  const Stepper::Plan& plan;
  RuleConstants constants;
  Setting setting = Setting::general;
  double reach = 0;    ///< of the rules, and what rounding could hide
  int look_ahead = 0;  ///< steps that a screening may serve
  ClosestPass look_up = nullptr;
  RuleLoop loop = nullptr;
};

[[nodiscard]] Run run_of(const Stepper::Plan& plan, std::span<const Object> objects);

/// The next steps of a run: what acts and where objects stand at each, and what depends on their
/// size.
struct Moments {
  std::vector<VelocityChanges> changes;
  std::vector<std::vector<Placed>> objects;  ///< and when the last step ends
  std::vector<Run> grown;                    ///< empty where no object grows
  std::vector<std::vector<Object>> sheets;   ///< at each step; that impacts hold against triangles

  [[nodiscard]] int n_steps() const { return static_cast<int>(changes.size()); }
  [[nodiscard]] const Run& run(int step, const Run& all) const {
    return grown.empty() ? all : grown[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] const std::vector<Placed>& objects_at(int step) const {
    return objects[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] const std::vector<Object>& sheets_at(int step) const {
    return sheets[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] const VelocityChanges& changes_at(int step) const {
    return changes[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] std::span<const VelocityChanges> changes_in(int from, int to) const {
    return std::span(changes).subspan(static_cast<std::size_t>(from),
                                      static_cast<std::size_t>(to - from));
  }
};

/// n_steps from `first` steps after time 0 on. The objects are left where they stand after them.
[[nodiscard]] Moments moments_of(const Run& run, std::vector<Object>& objects, double first,
                                 int n_steps);

}  // namespace tess::dn
