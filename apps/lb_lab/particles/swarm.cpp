#include "apps/lb_lab/particles/swarm.hpp"

#include "apps/lb_lab/run/kind.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace lb_lab {
namespace {

constexpr std::int32_t n_substeps = 16;
constexpr double nominal_particle_seconds = 0.35e-6;  // measured

// Of the whole run: drag, the attractor's pull (both as rates), kicks (as a diffusion, in squares
// of the lesser extent of the plane). The pull grows with the distance up to `reach` extents.
constexpr double drag = 40, pull = 16, diffusion = 0.5, reach = 0.3;

/// Within (−1, 1), from half of a hash.
double kick(std::uint64_t half) {
  return static_cast<double>(static_cast<std::int32_t>(half & 0xffffffffU)) * 0x1p-31;
}

/// A wall throws back what has passed it.
void bounce(double& x, double& v, double end) {
  if (x < 0) x = -x, v = -v;
  if (x >= end) x = 2 * end - x, v = -v;
  x = std::clamp(x, 0.0, std::nextafter(end, 0.0));
}

}  // namespace

Swarm::Swarm(const Problem& p)
    : width_(p.domain.width),
      height_(p.domain.height),
      n_iterations_(p.n_iterations),
      seed_(p.seed),
      n_particles_(n_items(p, nominal_particle_seconds)),
      seconds_(item_seconds(p, n_particles_)) {}

Particle Swarm::first(std::uint64_t number) const {
  const std::uint64_t hash = tess::mix(seed_ ^ tess::mix(number));
  const double x = (static_cast<double>(number) + 0.5) / static_cast<double>(n_particles_);
  return {number, x * width_, tess::unit(hash) * height_, 0, 0};
}

Swarm::Place Swarm::attractor(double iteration) const {
  const double phase = 2 * std::numbers::pi * iteration / n_iterations_;
  return {width_ * (0.5 - 0.3 * std::cos(phase)), height_ * (0.5 + 0.25 * std::sin(phase))};
}

void Swarm::advance(Particle& p, std::int32_t iteration, const Place* attractors) const {
  const double dt = 1 / (n_substeps * n_iterations_);  // of the run
  const double extent = std::min(width_, height_), soft = 1 / (reach * reach * extent * extent);
  const double kicks = extent * drag * std::sqrt(6 * diffusion * dt);
  std::uint64_t hash =
      tess::mix(seed_ + tess::mix(p.number)) + static_cast<std::uint64_t>(iteration);
  for (std::int32_t s = 0; s < n_substeps; ++s) {
    hash = tess::mix(hash);
    const double dx = attractors[s].x - p.x, dy = attractors[s].y - p.y;
    const double strength = pull * drag * dt / std::sqrt(1 + soft * (dx * dx + dy * dy));
    p.vx += strength * dx - drag * dt * p.vx + kicks * kick(hash);
    p.vy += strength * dy - drag * dt * p.vy + kicks * kick(hash >> 32U);
    p.x += dt * p.vx;
    p.y += dt * p.vy;
    bounce(p.x, p.vx, width_);
    bounce(p.y, p.vy, height_);
  }
}

void Swarm::advance(std::vector<Particle>& particles, std::int32_t iteration) const {
  std::array<Place, n_substeps> attractors{};
  for (std::int32_t s = 0; s < n_substeps; ++s)
    attractors[static_cast<std::size_t>(s)] = attractor(iteration + (s + 0.5) / n_substeps);
  for (Particle& particle : particles) advance(particle, iteration, attractors.data());
}

std::uint64_t Swarm::answer(const Particle& p) {
  std::uint64_t hash = tess::mix(p.number);
  for (const double value : {p.x, p.y, p.vx, p.vy})
    hash = tess::mix(hash ^ std::bit_cast<std::uint64_t>(value));
  return hash;
}

}  // namespace lb_lab
