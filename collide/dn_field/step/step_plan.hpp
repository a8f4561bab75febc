// What make_stepper() works out once for a scene: the constants of its rules and the loops that
// hold them. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/free_loop.hpp"
#include "collide/dn_field/rules/rule_table.hpp"
#include "collide/dn_field/step/screen.hpp"

namespace tess::dn {

struct Stepper::Plan {
  Rules rules;
  double step = 0;
  RuleConstants constants;
  bool looks_up = false;
  Sweep sweep = Sweep::off;
  Ask asked = Ask::both;
  RuleLoop loop_at_rest = nullptr, loop_general = nullptr;
  FreeLoop fly_free = nullptr;
};

}  // namespace tess::dn
