// One object that neither moves nor is turned, or none.
#include "collide/dn_field/rule_table.hpp"

namespace tess::dn {

RuleLoop rule_loop_at_rest(const LoopKey& key) {
  return chosen<Setting::one_at_rest>(key);
}

FreeLoop free_loop(Flight flight) {
  if (flight == Flight::none) return &lanes::free_loop<Flight::none>;
  return flight == Flight::fall ? &lanes::free_loop<Flight::fall> : &lanes::free_loop<Flight::air>;
}

}  // namespace tess::dn
