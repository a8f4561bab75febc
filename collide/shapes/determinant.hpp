// The determinant of three differences of points, for numbers of any kind (sign_of.hpp).
#pragma once

#include "collide/shapes/orientation.hpp"

namespace tess::collide::shapes {

/// `number` makes a number of a double.
template <class MakeNumber>
[[nodiscard]] auto determinant(const MakeNumber& number, const Difference& u, const Difference& v,
                               const Difference& w) noexcept {
  const auto along = [&](const Difference& d, std::size_t k) {
    return number(d.to[k]) - number(d.from[k]);
  };
  const auto u0 = along(u, 0), u1 = along(u, 1), u2 = along(u, 2);
  const auto v0 = along(v, 0), v1 = along(v, 1), v2 = along(v, 2);
  return (u1 * v2 - u2 * v1) * along(w, 0) + (u2 * v0 - u0 * v2) * along(w, 1) +
         (u0 * v1 - u1 * v0) * along(w, 2);
}

}  // namespace tess::collide::shapes
