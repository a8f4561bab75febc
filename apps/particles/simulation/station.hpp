// The context of the blocks on a PE: a group with one member per PE. It holds the stage of its
// process, the step loops, the objects at their current step, and the measures of the blocks.
#pragma once

#include "apps/particles/simulation/space.hpp"
#include "apps/particles/simulation/stage.hpp"
#include "runtime/core/exact_sum.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace particles {

class Block;

using tess::ExactSum;

/// Measures of all particles after a step: sums, extremes and counts that are the same bit for bit
/// for every order in which particles, blocks and PEs are joined.
struct Measured {
  std::uint64_t particles = 0;
  std::uint64_t blocks = 0;
  std::uint64_t nonfinite = 0;
  std::uint64_t inside = 0;     ///< below the surface of an object
  std::uint64_t tunnelled = 0;  ///< went through a surface
  double fastest = 0;           ///< speed
  double nearest = HUGE_VAL;    ///< least signed distance to an object, in world units
  ExactSum kinetic, potential;  ///< m v²/2 and −m g·x
  std::uint64_t hash = 0;       ///< of ids and the bits of positions and velocities

  void add(const Measured& other) {
    particles += other.particles;
    blocks += other.blocks;
    nonfinite += other.nonfinite;
    inside += other.inside;
    tunnelled += other.tunnelled;
    fastest = std::max(fastest, other.fastest);
    nearest = std::min(nearest, other.nearest);
    kinetic.add(other.kinetic);
    potential.add(other.potential);
    hash += other.hash;
  }
  friend Measured operator+(Measured a, const Measured& b) {
    a.add(b);
    return a;
  }
  /// Kinetic and potential; like kinetic.total() infinite or not a number where that of a particle
  /// is beyond all doubles. Particles with positions or velocities that are not finite are left
  /// out.
  [[nodiscard]] double energy() const {
    ExactSum both = kinetic;
    both.add(potential);
    return both.total();
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(particles, blocks, nonfinite, inside, tunnelled, fastest, nearest, kinetic, potential, hash);
  }
};

/// A run of steps between two exchanges of particles; the same for all blocks.
struct Stretch {
  enum Ask : std::uint32_t { nothing = 0, measure = 1, trace = 2, judge = 4 };
  std::int32_t first = 0;       ///< steps done before
  std::int32_t n_steps = 0;     ///< may be 0: to measure without moving
  std::uint32_t ask = nothing;  ///< at the end; judge: which particles ended inside an object
};

/// A traced particle at one time.
struct Sample {
  std::uint64_t id = 0;
  tess::dn::Vec3 position, velocity;
};

/// Seconds on one PE.
struct Spent {
  double rules = 0, audit = 0;  ///< CPU of the blocks
  double build = 0;             ///< of the slowest field
};

class Station : public tess::Group<Station> {
 public:
  // Set-up, an epoch each. The first PE of each process takes the stage and passes it on; all PEs
  // build.
  void take(StageHandle handle);
  void begin_fields();
  void fill_fields(std::int32_t stage);
  void finish_fields();
  void prepare(double block_edge);
  /// Makes this PE's share of the particles and sends them to their blocks.
  void emit(tess::ArrayProxy<Block> blocks);

  // For the blocks of this PE.
  [[nodiscard]] const Stage& stage() const { return *stage_; }
  [[nodiscard]] const Space& space() const { return space_; }
  [[nodiscard]] const tess::dn::Stepper& stepper(std::size_t species) const {
    return steppers_[species / 2];
  }
  /// The objects as they stand after so many steps; forward only.
  [[nodiscard]] const std::vector<tess::dn::Object>& objects(std::int32_t step);
  [[nodiscard]] Measured& measured() { return measured_; }
  [[nodiscard]] std::vector<Sample>& samples() { return samples_; }
  [[nodiscard]] Spent& spent() { return spent_; }

  // Reductions; the members keep nothing of what they give.
  void give_measured(tess::Callback<Measured> target);
  void give_samples(tess::Callback<std::vector<Sample>> target);
  void give_spent(tess::Callback<std::vector<Spent>> target);

 private:
  /// Does `action` to a field; errors name its object.
  template <class Action>
  void make(std::size_t field, const Action& action);
  /// The same to each field that this PE begins and finishes, with its number.
  template <class Action>
  void make_mine(const Action& action);

  std::shared_ptr<Stage> stage_;
  Space space_;
  std::vector<tess::dn::Stepper> steppers_;  // one per mass
  std::vector<tess::dn::Object> objects_;
  std::int32_t at_step_ = 0;  // of objects_
  Measured measured_;
  std::vector<Sample> samples_;
  Spent spent_;
};

}  // namespace particles
