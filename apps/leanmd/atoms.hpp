// The atoms of a cell, and what a step does with them: the numerics of a cell, without messages.
//
//     advance (kick, drift) -> [take_out, add] -> positions … their forces -> finish (kick)
//
// Atoms that cannot continue (too close or too fast) stay where they are from then on, and the
// totals say why.
#pragma once

#include "apps/leanmd/motion.hpp"
#include "apps/leanmd/problem.hpp"

#include <map>
#include <utility>

namespace leanmd {

/// Sums over all cells of a run of some steps. All but the trouble are exact.
struct Totals {
  std::vector<Vector> energies;  ///< per step: kinetic, potential, both together; in quanta
  Vector momentum{};
  std::int64_t n_atoms = 0;
  std::uint64_t hash = 0;
  Trouble trouble;
};
[[nodiscard]] Totals operator+(Totals a, const Totals& b);

/// An atom and the force on it.
using AtomForce = std::pair<Atom, Vector>;

class Atoms {
 public:
  Atoms() = default;
  explicit Atoms(const Problem& problem)
      : problem_(problem), motion_(problem.box.edge, problem.dt) {}

  void add(const std::vector<Atom>& atoms);
  /// The first half of a step.
  void advance(std::int32_t step);
  /// Takes out all atoms, and sorts them by the cells where they are: `own`, and those that touch
  /// it.
  [[nodiscard]] std::map<tess::Index3, std::vector<Atom>> take_out(const tess::Index3& own);
  [[nodiscard]] std::vector<Position> positions() const;
  /// The second half, with the forces at these positions. Returns the energies of the step.
  Vector finish(Forces forces);
  /// Reverses all velocities.
  void reverse();

  [[nodiscard]] std::vector<AtomForce> with_forces() const;
  [[nodiscard]] Totals totals(std::vector<Vector> energies) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(problem_, motion_, atoms_, forces_, moved_, trouble_);
  }

 private:
  Problem problem_;
  Motion motion_;
  std::vector<Atom> atoms_;
  Forces forces_;     // on them, in their order
  double moved_ = 0;  // bound of the way of any atom since the last exchange
  Trouble trouble_;
};

}  // namespace leanmd
