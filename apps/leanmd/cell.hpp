// A cell of the box with its atoms: an element of a dense array. A step is one coroutine:
//
//     kick, drift -> [exchange atoms with the cells around] -> multicast the coordinates to the
//     computes of this cell -> await the sum of their forces -> kick -> the next step
//
// There is no barrier: cells may be a step apart. A cell that cannot continue (atoms too close or too
// fast) keeps its atoms where they are until the end of the run, which reports it.
#pragma once

#include "apps/leanmd/compute.hpp"
#include "apps/leanmd/motion.hpp"

#include <string>
#include <utility>

namespace leanmd {

/// What all elements know.
struct Problem {
  Box box;
  double cutoff = 2.5;
  double dt = 0.004;
  double skin = 0.4;                ///< an atom moves at most half of it between two exchanges
  std::int32_t exchange_every = 5;  ///< steps between exchanges of atoms
  std::int32_t every = 20;          ///< steps between reports, and between balance barriers
};

/// Why a run cannot continue: the first reason is kept.
struct Trouble {
  enum class Kind : std::uint8_t { too_close, too_fast, too_far };
  std::int32_t step = -1;  ///< -1: none
  Kind kind{};
  double value = 0;  ///< distance or speed
  std::int64_t atom = 0;

  friend auto operator<=>(const Trouble&, const Trouble&) = default;
  [[nodiscard]] explicit operator bool() const { return step >= 0; }
};

/// Sums over all cells of a run of some steps. All but the trouble are exact.
struct Totals {
  std::vector<Vector> energies;  ///< per step: kinetic, potential, both together; in quanta
  Vector momentum{};
  std::int64_t n_atoms = 0;
  std::uint64_t hash = 0;
  Trouble trouble;
};
struct AddTotals {
  Totals operator()(Totals a, const Totals& b) const;
};

/// Some steps: after the last the totals go to `done`. The energies are those of first … last.
struct Run {
  std::int32_t first = 0, last = 0;
  tess::Callback<Totals> done;
};

class Cell : public tess::Chare<Cell, tess::Index3> {
 public:
  Cell() = default;
  Cell(const Problem& problem, tess::ArrayProxy<Compute> computes)
      : problem_(problem), motion_(problem.box.edge, problem.dt), all_computes_(computes) {}

  // Before the first run, in this order: an epoch each.
  void fill(std::vector<Atom> atoms) { atoms_ = std::move(atoms); }
  void create_computes();
  void create_section();

  void begin(Run run);
  tess::Task step(std::int32_t step);
  /// Reverses all velocities.
  void reverse();
  /// All atoms with the forces on them, to `result`.
  using AtomForce = std::pair<Atom, Vector>;
  void show(const tess::Callback<std::vector<AtomForce>>& result);

  // Messages of a step.
  struct Arrivals {
    std::int32_t step = 0;
    std::vector<Atom> atoms;
  };
  void receive_forces(Forces forces) { forces_box_.put(std::move(forces)); }
  void receive_atoms(Arrivals arrivals) { arrivals_box_.put(std::move(arrivals)); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(problem_, motion_, all_computes_, computes_, atoms_, forces_, moved_, run_, totals_,
       forces_box_, arrivals_box_);
  }

 private:
  [[nodiscard]] std::vector<tess::Index3> partners() const;
  void advance(std::int32_t step);
  void send_leavers(std::int32_t step);
  void check_forces();
  [[nodiscard]] Vector energies() const;
  void sum_up();

  Problem problem_;
  Motion motion_;
  tess::ArrayProxy<Compute> all_computes_;
  tess::SectionProxy<Compute> computes_;  // those of this cell
  std::vector<Atom> atoms_;
  Forces forces_;     // on them, in their order
  double moved_ = 0;  // bound of the way of any atom since the last exchange
  Run run_;
  Totals totals_;
  tess::Mailbox<&Forces::step> forces_box_;
  tess::Mailbox<&Arrivals::step> arrivals_box_;
};

}  // namespace leanmd
