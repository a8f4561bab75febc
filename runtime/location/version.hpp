// What orders the news of where an element is.
#pragma once

#include <compare>
#include <cstdint>

namespace tess {

/// Which life of an index (incarnation) and which place of that life (epoch, one more for each
/// migration). Later knowledge has the greater version; {0, 0} is no knowledge.
struct Version {
  std::uint32_t incarnation = 0;
  std::uint32_t epoch = 0;
  friend constexpr auto operator<=>(const Version&, const Version&) = default;
};

}  // namespace tess
