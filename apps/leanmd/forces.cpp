#include "apps/leanmd/forces.hpp"

#include <cmath>

namespace leanmd {
namespace {

void note_closest(Forces& forces, std::size_t atom, double distance) {
  if (distance >= forces.closest_distance) return;
  forces.closest = static_cast<std::int32_t>(atom);
  forces.closest_distance = distance;
}

}  // namespace

Forces AddForces::operator()(Forces a, const Forces& b) const {
  for (std::size_t i = 0; i < a.on.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) a.on[i][k] += b.on[i][k];
  a.energy += b.energy;
  if (b.closest >= 0) note_closest(a, static_cast<std::size_t>(b.closest), b.closest_distance);
  return a;
}

LennardJones::LennardJones(double edge, double cutoff) : edge_(edge), cutoff2_(cutoff * cutoff) {
  const double inverse6 = 1 / (cutoff2_ * cutoff2_ * cutoff2_);
  c_ = (24 * inverse6 * inverse6 - 12 * inverse6) / cutoff2_;
  e_ = 4 * inverse6 - 4 * inverse6 * inverse6 - c_ * cutoff2_;
}

inline void LennardJones::add_pair(const Position& a, const Position& b, std::size_t i,
                                   std::size_t j, Forces& on_a, Forces& on_b) const {
  const double unit = edge_ * 0x1p-64;
  const double x = unit * static_cast<double>(static_cast<std::int64_t>(a[0] - b[0]));
  const double y = unit * static_cast<double>(static_cast<std::int64_t>(a[1] - b[1]));
  const double z = unit * static_cast<double>(static_cast<std::int64_t>(a[2] - b[2]));
  const double distance2 = x * x + y * y + z * z;
  if (distance2 >= cutoff2_) return;
  if (distance2 < least_distance * least_distance) [[unlikely]] {
    note_closest(on_a, i, std::sqrt(distance2));
    note_closest(on_b, j, std::sqrt(distance2));
    return;
  }
  const double inverse2 = 1 / distance2;
  const double inverse6 = inverse2 * inverse2 * inverse2;
  const double force = (48 * inverse6 - 24) * inverse6 * inverse2 - 2 * c_;  // over the distance
  const double energy = 4 * (inverse6 - 1) * inverse6 + c_ * distance2 + e_;
  // Rounding to the nearest is symmetric, so the two forces are opposite.
  const double scaled = force / force_quantum;
  const Vector quanta{std::llrint(scaled * x), std::llrint(scaled * y), std::llrint(scaled * z)};
  for (std::size_t k = 0; k < 3; ++k) {
    on_a.on[i][k] += quanta[k];
    on_b.on[j][k] -= quanta[k];
  }
  on_a.energy += std::llrint(energy / energy_quantum);
}

void LennardJones::add(std::span<const Position> a, std::span<const Position> b, Forces& on_a,
                       Forces& on_b) const {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) add_pair(a[i], b[j], i, j, on_a, on_b);
}

void LennardJones::add(std::span<const Position> a, Forces& on_a) const {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = i + 1; j < a.size(); ++j) add_pair(a[i], a[j], i, j, on_a, on_a);
}

}  // namespace leanmd
