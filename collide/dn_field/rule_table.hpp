// The instances of rule_loop() and the choice among them. They are compiled in two sources, one for
// each setting, for they take long. Private to the step loop.
#pragma once

#include "collide/dn_field/rule_loop.hpp"

namespace tess::dn {

/// Which rules a loop holds.
struct LoopKey {
  Flight flight = Flight::none;
  Impacts impacts = Impacts::none;
  Springs springs = Springs::none;
  Flows flows = Flows::none;
};

template <Setting Where, Flight Flies, Impacts Hits, Springs Springy>
RuleLoop chosen(Flows flows) {
  return flows == Flows::none ? &lanes::rule_loop<Flies, Hits, Springy, Flows::none, Where>
                              : &lanes::rule_loop<Flies, Hits, Springy, Flows::turned, Where>;
}
template <Setting Where, Flight Flies, Impacts Hits>
RuleLoop chosen(Springs springs, Flows flows) {
  return springs == Springs::none ? chosen<Where, Flies, Hits, Springs::none>(flows)
                                  : chosen<Where, Flies, Hits, Springs::exact>(flows);
}
template <Setting Where, Flight Flies>
RuleLoop chosen(Impacts impacts, Springs springs, Flows flows) {
  if (impacts == Impacts::none) return chosen<Where, Flies, Impacts::none>(springs, flows);
  if (impacts == Impacts::plain) return chosen<Where, Flies, Impacts::plain>(springs, flows);
  return chosen<Where, Flies, Impacts::swept>(springs, flows);
}
template <Setting Where>
RuleLoop chosen(const LoopKey& key) {
  if (key.flight == Flight::none)
    return chosen<Where, Flight::none>(key.impacts, key.springs, key.flows);
  if (key.flight == Flight::fall)
    return chosen<Where, Flight::fall>(key.impacts, key.springs, key.flows);
  if (key.flight == Flight::air)
    return chosen<Where, Flight::air>(key.impacts, key.springs, key.flows);
  return chosen<Where, Flight::surface>(key.impacts, key.springs, key.flows);
}

[[nodiscard]] RuleLoop rule_loop_at_rest(const LoopKey& key);
[[nodiscard]] RuleLoop rule_loop_general(const LoopKey& key);

}  // namespace tess::dn
