// The rules of a scene file.
#pragma once

#include "apps/particles/scene/json_reader.hpp"
#include "collide/dn_field/rules.hpp"

namespace particles {

/// Throws tess::Error for what is wrong.
[[nodiscard]] tess::dn::Rules read_rules(const Node& node);

}  // namespace particles
