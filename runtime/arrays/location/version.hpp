// The order of location updates.
#pragma once

#include <compare>
#include <cstdint>

namespace tess::detail {

/// The life of an index (incarnation) and the place of that life (epoch, which each migration
/// increments). Later knowledge has the greater version; {0, 0} means that nothing is known.
struct Version {
  std::uint32_t incarnation = 0;
  std::uint32_t epoch = 0;
  friend constexpr auto operator<=>(const Version&, const Version&) = default;
};

}  // namespace tess::detail
