// The motion of atoms by velocity Verlet in whole numbers (Levesque and Verlet 1993). A velocity
// counts units of force_quantum dt/2, so that half a kick is the addition of the force; a drift is
// rounded to the unit of positions. Hence two properties that every run can be checked by: the
// total momentum stays what it was, to the last bit; and a run that is turned round, by reversing
// all velocities, returns to its start.
#pragma once

#include "apps/leanmd/forces.hpp"

#include <span>

namespace leanmd {

struct Atom {
  std::int64_t id = 0;
  Position at{};
  Vector velocity{};
};

/// No component of a velocity and no energy overflows below it; dt is at least least_dt.
inline constexpr double greatest_speed = 512;
inline constexpr double least_dt = 1e-5;

class Motion {
 public:
  Motion() = default;
  Motion(double edge, double dt);

  /// v in units of length and time, in units of atoms.
  [[nodiscard]] std::int64_t velocity(double v) const;
  /// An atom's speed in units of length and time, and its kinetic energy in quanta.
  [[nodiscard]] double speed(const Atom& atom) const;
  [[nodiscard]] std::int64_t energy(const Atom& atom) const;

  static void kick(std::span<Atom> atoms, std::span<const Vector> forces);
  void drift(std::span<Atom> atoms) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(unit_, step_);
  }

 private:
  double unit_ = 0;  // of velocities
  double step_ = 0;  // what a drift adds to a position for each unit of velocity
};

/// An initial state: `n` of the points of a cubic lattice, drawn at random, and velocities of a
/// temperature whose sum is 0. With a gradient (0 ... 1) the points at small x are chosen more
/// often, in proportion to 1 + gradient (1 - 2 x/edge). The same for equal arguments.
struct InitialState {
  std::int32_t n_atoms = 0;
  double edge = 1, gradient = 0, temperature = 1;
  std::uint64_t seed = 1;
};
[[nodiscard]] std::vector<Atom> initial_atoms(const InitialState& state, const Motion& motion);

/// A hash of an atom, to be added to those of others.
[[nodiscard]] std::uint64_t hash_of(const Atom& atom);

}  // namespace leanmd
