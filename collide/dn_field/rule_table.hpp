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
};

template <Setting Where, Flight Flies, Impacts Hits>
RuleLoop chosen(Springs springs) {
  return springs == Springs::none ? &lanes::rule_loop<Flies, Hits, Springs::none, Where>
                                  : &lanes::rule_loop<Flies, Hits, Springs::exact, Where>;
}
template <Setting Where, Flight Flies>
RuleLoop chosen(Impacts impacts, Springs springs) {
  if (impacts == Impacts::none) return chosen<Where, Flies, Impacts::none>(springs);
  if (impacts == Impacts::plain) return chosen<Where, Flies, Impacts::plain>(springs);
  return chosen<Where, Flies, Impacts::swept>(springs);
}
template <Setting Where>
RuleLoop chosen(const LoopKey& key) {
  if (key.flight == Flight::none) return chosen<Where, Flight::none>(key.impacts, key.springs);
  if (key.flight == Flight::fall) return chosen<Where, Flight::fall>(key.impacts, key.springs);
  if (key.flight == Flight::air) return chosen<Where, Flight::air>(key.impacts, key.springs);
  return chosen<Where, Flight::surface>(key.impacts, key.springs);
}

[[nodiscard]] RuleLoop rule_loop_at_rest(const LoopKey& key);
[[nodiscard]] RuleLoop rule_loop_general(const LoopKey& key);

}  // namespace tess::dn
