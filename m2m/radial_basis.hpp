// Interpolation by radial basis functions: one dense system over all source points, factored once and
// applied often. It takes n² memory and n³ time on one thread, so it is a reference for up to some
// ten thousand points, beside which the errors and times of couplings are judged:
//
//     RadialBasis basis(source.points);
//     basis.values(temperature, 1, target.points);
//     basis.values(pressure, 1, target.points);     // no second factorisation
//
// The interpolant is s(x) = Σ c_j φ(|x - x_j|) + p(x) with a linear polynomial p, where Σ c_j q(x_j) is
// 0 for all linear q (Wendland 2005, section 8.5). It has the source values at the source points, and
// is exact for linear fields. The system is solved on the complement of the polynomials, where it is
// positive definite for both kernels.
#pragma once

#include "m2m/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tess::m2m {

enum class RadialKernel : std::uint8_t {
  thin_plate,  ///< r² log r
  wendland,  ///< (1 - r / radius)⁴ (4 r / radius + 1) within the radius, otherwise 0 (Wendland 1995)
};

struct RadialBasisOptions {
  RadialKernel kernel = RadialKernel::thin_plate;
  double radius = 0;  ///< of the kernel wendland, in units of the points
};

class RadialBasis {
 public:
  /// With more points the matrix would need more than 3.2 GB.
  static constexpr std::size_t most_points = 20'000;

  /// Factors the system. Throws Error (bad_mesh) if there are more than most_points or fewer than
  /// four, if a coordinate is not finite, if all lie in a plane, or if the system is singular or
  /// ill-conditioned, as with two points in one place; (bad_argument) for a radius that is not positive.
  explicit RadialBasis(std::span<const Point> points, const RadialBasisOptions& options = {});
  RadialBasis(RadialBasis&& other) noexcept;
  RadialBasis& operator=(RadialBasis&& other) noexcept;
  ~RadialBasis();

  /// The values at the targets. `source_values`: points × n_components, row-major, and likewise the
  /// result.
  [[nodiscard]] std::vector<double> values(std::span<const double> source_values,
                                           std::size_t n_components,
                                           std::span<const Point> targets) const;

 private:
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace tess::m2m
