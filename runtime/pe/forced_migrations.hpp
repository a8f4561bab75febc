// Migrations that a simulated machine forces after messages, for tests: drawn at random, or chosen
// by an ElementMover.
#pragma once

#include "runtime/core/hash.hpp"
#include "runtime/pe/interfaces/element_mover.hpp"

#include <cstdint>

namespace tess::detail {

class ForcedMigrations {
 public:
  ForcedMigrations(std::int32_t n_pes, std::uint64_t seed) : n_pes_(n_pes), random_(seed) {}

  void set(double chance, ElementMover* mover) {
    chance_ = chance;
    mover_ = mover;
  }
  /// The PE that the element must move to now, or `after.pe`.
  [[nodiscard]] PeId next(const AfterMessage& after) {
    if (mover_ != nullptr) return mover_->move(after);
    if (chance_ == 0 || !random_.chance(chance_)) return after.pe;
    return PeId{static_cast<std::int32_t>(random_.below(static_cast<std::uint64_t>(n_pes_)))};
  }

 private:
  const std::int32_t n_pes_;
  Random random_;
  double chance_ = 0;
  ElementMover* mover_ = nullptr;
};

}  // namespace tess::detail
