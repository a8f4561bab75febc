#include "collide/dn_field/stepper.hpp"

#include "collide/dn_field/step/block_flight.hpp"

#include <algorithm>
#include <array>

namespace tess::dn {
namespace {
constexpr int steps_at_once = 64;  // for which the objects' positions are made in advance

/// The number of steps since time 0, whole where `time` is meant to be a sum or multiple of steps:
/// then a run from there sees the same times to the bit as one that came by.
double steps_before(double time, double step) {
  const double steps = time / step, whole = std::round(steps);
  return std::abs(steps - whole) < 1e-6 ? whole : steps;
}

/// The last particles, fewer than a vector, in room for one.
class Rest {
 public:
  explicit Rest(const ParticleSpan& particles) : from_(particles) {
    for_each([](double& room, double& particle) { room = particle; });
  }
  void put_back() {
    for_each([](double& room, double& particle) { particle = room; });
  }
  [[nodiscard]] ParticleSpan span() {
    return {room_[0].data(), room_[1].data(), room_[2].data(), room_[3].data(),
            room_[4].data(), room_[5].data(), lanes::width};
  }

 private:
  template <class Copy>
  void for_each(const Copy& copy) {
    const std::array<double*, 6> particles{from_.x, from_.y, from_.z, from_.vx, from_.vy, from_.vz};
    for (std::size_t a = 0; a < particles.size(); ++a)
      for (std::size_t i = 0; i < from_.count; ++i) copy(room_[a][i], particles[a][i]);
  }

  ParticleSpan from_;
  std::array<std::array<double, lanes::width>, 6> room_{};
};

}  // namespace

void Stepper::run(ParticleSpan particles, std::span<const Object> objects, double time,
                  int n_steps) const {
  run(particles, objects, time, n_steps, nullptr);
}

std::vector<Waypoint> Stepper::run_once(ParticleSpan particles, std::span<const Object> objects,
                                        double time) const {
  std::vector<Waypoint> waypoints;
  run(particles, objects, time, 1, &waypoints);
  return waypoints;
}

void Stepper::run(ParticleSpan particles, std::span<const Object> objects, double time, int n_steps,
                  std::vector<Waypoint>* waypoints) const {
  const Plan& plan = *plan_;
  const Run run = run_of(plan, objects);
  std::vector<Object> standing(objects.begin(), objects.end());
  if (!plan.looks_up) standing.clear();
  const double before = steps_before(time, plan.step);
  const auto flight = std::make_unique<BlockFlight>(waypoints != nullptr);
  const std::size_t whole = particles.count / lanes::width * lanes::width;
  Rest rest(particles.part(whole, particles.count - whole));
  for (int done = 0; done < n_steps; done += steps_at_once) {
    const int now = std::min(steps_at_once, n_steps - done);
    const Moments moments = moments_of(run, standing, before + done, now);
    const auto fly = [&](std::size_t first, const ParticleSpan& block) {
      flight->fly(run, moments, block);
      if (waypoints == nullptr) return;
      for (const Waypoint& bend : flight->waypoints())
        if (first + bend.particle < particles.count)
          waypoints->push_back({first + bend.particle, bend.part, bend.place});
    };
    for (std::size_t first = 0; first < whole; first += block_size)
      fly(first, particles.part(first, std::min(block_size, whole - first)));
    if (whole < particles.count) fly(whole, rest.span());
  }
  rest.put_back();
}

}  // namespace tess::dn
