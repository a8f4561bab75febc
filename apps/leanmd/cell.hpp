// A cell of the box with its atoms: an element of a dense array. A step is one coroutine:
//
//     kick, drift -> [exchange atoms with the cells around] -> multicast the coordinates to the
//     computes of this cell -> await the sum of their forces -> kick -> the next step
//
// There is no barrier: cells may be a step apart. A cell that cannot continue (atoms too close or
// too fast) keeps its atoms where they are until the end of the run, which reports it.
#pragma once

#include "apps/leanmd/atoms.hpp"
#include "apps/leanmd/compute.hpp"
#include "runtime/more/section.hpp"

namespace leanmd {

/// Some steps: after the last the totals go to `done`. The energies are those of first … last.
struct Run {
  std::int32_t first = 0, last = 0;
  tess::Callback<Totals> done;
};

/// Atoms that enter a cell at a step.
struct Arrivals {
  std::int32_t step = 0;
  std::vector<Atom> atoms;
};

class Cell : public tess::Chare<Cell, tess::Index3> {
 public:
  Cell() = default;
  Cell(const Problem& problem, tess::ArrayProxy<Compute> all_computes)
      : problem_(problem), all_computes_(all_computes), atoms_(problem) {}

  // Before the first run.
  void fill(const std::vector<Atom>& atoms) { atoms_.add(atoms); }
  void create_computes();

  void begin(Run run);
  tess::Task step(std::int32_t step);
  void receive_forces(Forces forces) { forces_.put(std::move(forces)); }
  void receive_atoms(Arrivals arrivals) { arrivals_.put(std::move(arrivals)); }

  void reverse() { atoms_.reverse(); }
  /// All atoms with the forces on them, to `result`.
  void show(const tess::Callback<std::vector<AtomForce>>& result) {
    contribute(tess::concatenate, atoms_.with_forces(), result);
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(problem_, all_computes_, computes_, atoms_, run_, energies_, forces_, arrivals_);
  }

 private:
  /// The lowest layer of cells on the page of --monitor.
  void draw() const;

  Problem problem_;
  tess::ArrayProxy<Compute> all_computes_;
  tess::SectionProxy<Compute> computes_;  // those of this cell
  Atoms atoms_;
  Run run_;
  std::vector<Vector> energies_;  // of its steps so far
  tess::Mailbox<&Forces::step> forces_;
  tess::Mailbox<&Arrivals::step> arrivals_;
};

}  // namespace leanmd
