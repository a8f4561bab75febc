// The instances of rule_loop() and the choice among them. They are compiled in two sources, one for
// each setting, for they take long. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/rule_loop.hpp"

namespace tess::dn {

/// Which rules a loop holds.
struct LoopKey {
  Flight flight;
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
template <Setting Where, bool Falls>
RuleLoop chosen(const LoopKey& key) {
  if (key.flight.drags == Drags::none)
    return chosen<Where, Flight{Falls}>(key.impacts, key.springs);
  if (key.flight.drags == Drags::everywhere)
    return chosen<Where, Flight{Falls, Drags::everywhere}>(key.impacts, key.springs);
  return chosen<Where, Flight{Falls, Drags::surface}>(key.impacts, key.springs);
}
template <Setting Where>
RuleLoop chosen(const LoopKey& key) {
  return key.flight.falls ? chosen<Where, true>(key) : chosen<Where, false>(key);
}

[[nodiscard]] RuleLoop rule_loop_at_rest(const LoopKey& key);
[[nodiscard]] RuleLoop rule_loop_general(const LoopKey& key);

}  // namespace tess::dn
