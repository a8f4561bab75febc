#include "apps/leanmd/motion.hpp"

#include "runtime/core/hash.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace leanmd {

Motion::Motion(double edge, double dt)
    : unit_(force_quantum * dt / 2), step_(unit_ * dt / edge * 0x1p64) {}

std::int64_t Motion::velocity(double v) const {
  return std::llrint(v / unit_);
}

double Motion::speed(const Atom& atom) const {
  const auto [x, y, z] = atom.velocity;
  return unit_ * std::hypot(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
}

std::int64_t Motion::energy(const Atom& atom) const {
  const double v = speed(atom);
  return std::llrint(v * v / (2 * energy_quantum));
}

void Motion::kick(std::span<Atom> atoms, std::span<const Vector> forces) {
  for (std::size_t i = 0; i < atoms.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) atoms[i].velocity[k] += forces[i][k];
}

void Motion::drift(std::span<Atom> atoms) const {
  for (Atom& atom : atoms)
    for (std::size_t k = 0; k < 3; ++k) {
      const double way = step_ * static_cast<double>(atom.velocity[k]);
      atom.at[k] += static_cast<std::uint64_t>(std::llrint(way));
    }
}

std::vector<Atom> initial_atoms(const InitialState& state, const Motion& motion) {
  constexpr double wide = 1.05;  // a spacing at which atoms neither overlap nor fly apart
  const double most = 2 * std::cbrt(state.n_atoms);  // points per atom are bounded
  std::int64_t side = static_cast<std::int64_t>(std::min(state.edge / wide, most));
  while (side * side * side < state.n_atoms) ++side;

  // A draw without replacement by weight: the points with the least keys -log(u) / weight
  // (Efraimidis and Spirakis 2006).
  tess::Random random(state.seed);
  std::vector<std::pair<double, std::int64_t>> points;
  for (std::int64_t point = 0; point < side * side * side; ++point) {
    const double x = (static_cast<double>(point % side) + 0.5) / static_cast<double>(side);
    const double weight = 1 + state.gradient * (1 - 2 * x);
    points.emplace_back(-std::log1p(-random.unit()) / weight, point);
  }
  std::ranges::sort(points);
  points.resize(static_cast<std::size_t>(state.n_atoms));
  std::ranges::sort(points, {}, &std::pair<double, std::int64_t>::second);

  const std::uint64_t spacing = ~std::uint64_t{0} / static_cast<std::uint64_t>(side);
  std::vector<Atom> atoms;
  Vector sum{};
  for (const auto& [key, point] : points) {
    Atom atom{static_cast<std::int64_t>(atoms.size())};
    std::int64_t rest = point;
    for (std::size_t k = 0; k < 3; ++k, rest /= side) {
      atom.at[k] = static_cast<std::uint64_t>(rest % side) * spacing + spacing / 2;
      const double radius = std::sqrt(-2 * state.temperature * std::log1p(-random.unit()));
      const double angle = 2 * std::numbers::pi * random.unit();
      atom.velocity[k] = motion.velocity(radius * std::cos(angle));  // normally distributed
      sum[k] += atom.velocity[k];
    }
    atoms.push_back(atom);
  }
  if (atoms.size() < 2) return atoms;  // one atom keeps its velocity
  const auto n = static_cast<std::int64_t>(atoms.size());
  for (std::size_t k = 0; k < 3; ++k) {
    for (Atom& atom : atoms) atom.velocity[k] -= sum[k] / n;
    atoms.front().velocity[k] -= sum[k] % n;
  }
  return atoms;
}

std::uint64_t hash_of(const Atom& atom) {
  return tess::hash_bytes(&atom, sizeof atom);
}

}  // namespace leanmd
