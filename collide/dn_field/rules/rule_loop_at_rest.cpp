// One object that neither moves nor is turned.
#include "collide/dn_field/rules/rule_loop.hpp"

namespace tess::dn {

RuleLoop rule_loop_at_rest(const LoopKey& key) {
  return chosen<Setting::one_at_rest>(key);
}

}  // namespace tess::dn
