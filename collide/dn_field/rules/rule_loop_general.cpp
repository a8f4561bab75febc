// Several objects, or one that moves or is turned.
#include "collide/dn_field/rules/rule_loop.hpp"

namespace tess::dn {

RuleLoop rule_loop_general(const LoopKey& key) {
  return chosen<Setting::general>(key);
}

}  // namespace tess::dn
