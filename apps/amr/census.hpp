// What is known of the field and of the tree: sums over all cells and over all leaves.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace amr {

/// What is known of cells. Integers, so that sums do not depend on their order.
struct Norms {
  std::int64_t mass = 0;        ///< quanta
  std::int64_t l1 = 0, l2 = 0;  ///< of the integrals of |error| and error², 2^-60 each
  double linf = 0, largest = -HUGE_VAL, least = HUGE_VAL;
  std::uint64_t hash = 0;
};

/// What is known of leaves.
struct Census {
  Norms norms;
  std::int64_t n_blocks = 0;
  std::int64_t n_new = 0;  ///< since the last census
  std::array<std::int64_t, 12> of_level{};
};

[[nodiscard]] Norms operator+(const Norms& a, const Norms& b);
[[nodiscard]] Census operator+(Census a, const Census& b);

}  // namespace amr
