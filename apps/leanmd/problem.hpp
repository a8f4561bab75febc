// What a run computes, and why it may be unable to continue.
#pragma once

#include "apps/leanmd/box.hpp"

#include <string>

namespace leanmd {

/// What all elements know.
struct Problem {
  Box box;
  double cutoff = 2.5;
  double dt = 0.004;
  double skin = 0.4;                ///< an atom moves at most half of it between two exchanges
  std::int32_t exchange_every = 5;  ///< steps between exchanges of atoms
  std::int32_t every = 20;          ///< steps between reports, and between balance barriers

  [[nodiscard]] bool exchanges_at(std::int32_t step) const { return step % exchange_every == 0; }
};

/// Why a run cannot continue: the first reason is kept.
struct Trouble {
  enum class Kind : std::uint8_t { too_close, too_fast, too_far };
  std::int32_t step = -1;  ///< -1: none
  Kind kind{};
  double value = 0;  ///< distance or speed
  std::int64_t atom = 0;

  friend auto operator<=>(const Trouble&, const Trouble&) = default;
  [[nodiscard]] explicit operator bool() const { return step >= 0; }
};

/// What is wrong, where, and what helps.
[[nodiscard]] std::string describe(const Trouble& trouble, const Problem& problem);

}  // namespace leanmd
