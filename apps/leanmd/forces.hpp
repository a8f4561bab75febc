// The forces between atoms: Lennard-Jones in reduced units (the atom's diameter, the depth of the
// well and the mass are 1), with the term in r² of Stoddard and Ford (1973), which makes energy and
// force 0 at the cutoff:
//
//     U(r) = 4 (r^-12 - r^-6) + c r² + e
//
// The force of each pair is rounded to a quantum, and opposite for its two atoms. Sums of quanta
// are exact, so a force does not depend on the order of summation: not on cells, PEs, or schedules.
//
// No sum overflows. A pair closer than least_distance, where the force reaches 2^20, is an error
// and adds nothing. All others are that far apart, so at most 2^8 of them repel an atom: 2^60
// quanta. The attraction is below 2.4 per pair.
#pragma once

#include "apps/leanmd/box.hpp"

#include <limits>
#include <span>
#include <vector>

namespace leanmd {

inline constexpr double force_quantum = 0x1p-32;
inline constexpr double energy_quantum = 0x1p-24;
/// (48 / 2^20)^(1/13), rounded up.
inline constexpr double least_distance = 0.4637;

/// The forces on the atoms of a cell, or the part that comes from some pairs.
struct Forces {
  std::int32_t step = 0;
  std::vector<Vector> on;     ///< per atom, in quanta
  std::int64_t energy = 0;    ///< potential energy, in quanta
  std::int32_t closest = -1;  ///< the atom that is closer to another than least_distance
  double closest_distance = std::numeric_limits<double>::infinity();
};
struct AddForces {
  Forces operator()(Forces a, const Forces& b) const;
};

class LennardJones {
 public:
  LennardJones() = default;
  /// cutoff: at most half of the edge, so that no atom meets two images of another.
  LennardJones(double edge, double cutoff);

  /// Adds the forces between the atoms of two cells. The energy goes to the first cell.
  void add(std::span<const Position> a, std::span<const Position> b, Forces& on_a,
           Forces& on_b) const;
  /// Adds the forces between the atoms of one cell.
  void add(std::span<const Position> a, Forces& on_a) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(edge_, cutoff2_, c_, e_);
  }

 private:
  void add_pair(const Position& a, const Position& b, std::size_t i, std::size_t j, Forces& on_a,
                Forces& on_b) const;

  double edge_ = 1, cutoff2_ = 0, c_ = 0, e_ = 0;
};

}  // namespace leanmd
