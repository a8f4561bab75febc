// The problem of the stencil program: −Δu = f on the unit square, u = 0 on its border, with
// f = 2π² sin(πx) sin(πy), on `size` × `size` interior points. It is chosen for its answer: the
// solution is u = sin(πx) sin(πy), and since that is an eigenvector of the five-point stencil, the
// k-th Jacobi iterate from zero is a_k u exactly, so every run can be checked to rounding.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace stencil {

struct Problem {
  std::int32_t size = 0;  ///< interior points on each axis

  [[nodiscard]] double spacing() const { return 1.0 / (size + 1); }

  /// The solution at interior point (i, j), 0 … size − 1 each.
  [[nodiscard]] double solution(std::int32_t i, std::int32_t j) const { return wave(i) * wave(j); }
  /// sin(πx) at the interior coordinate i; the solution is a product of two.
  [[nodiscard]] double wave(std::int32_t i) const {
    return std::sin(std::numbers::pi * (i + 1) * spacing());
  }

  /// a_k: the amplitude of the iterate after `steps` steps. From a_0 = 0 and
  /// a_{k+1} = cos(πh) a_k + h²π²/2.
  [[nodiscard]] double amplitude(std::int32_t steps) const {
    const double h = spacing();
    const double pi = std::numbers::pi;
    const double half = std::sin(pi * h / 2);  // 1 − cos(πh) = 2 half², without cancellation
    const double grown = -std::expm1(steps * std::log1p(-2 * half * half));
    return h * h * pi * pi / 2 * grown / (2 * half * half);
  }
  /// How far rounding may take a value of about 1 from the iterate: four spacings in each of the
  /// last steps, of which 1 / (1 − cos(πh)) count.
  [[nodiscard]] double rounding(std::int32_t steps) const {
    const double half = std::sin(std::numbers::pi * spacing() / 2);
    return 1e-12 + 1e-15 * std::min<double>(steps, 1 / (2 * half * half));
  }
};

}  // namespace stencil
