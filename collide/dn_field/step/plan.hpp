// What make_stepper() computes once for a scene: the constants of its rules and the loops that hold
// them. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/rule_loop.hpp"
#include "collide/dn_field/stepper.hpp"

namespace tess::dn {

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

}  // namespace tess::dn
