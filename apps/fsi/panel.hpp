// A piece of the panel: point masses that springs hold together, moved by many small steps between
// two meetings with the fluid.
#pragma once

#include "apps/fsi/problem.hpp"
#include "apps/fsi/strip.hpp"
#include "apps/fsi/sums.hpp"
#include "m2m/coupling.hpp"
#include "runtime/mailbox.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fsi {

class Panel : public tess::Chare<Panel, tess::Index1>, public tess::m2m::Piece<Panel> {
 public:
  Panel() = default;
  explicit Panel(const Problem& problem);

  /// A step begins: what was reached is its start. The guess is how the panel goes on by itself.
  void begin();
  /// Moves from the start of the step to its end, under the force of this step.
  tess::Task move();
  /// The residual, by which the panel's move differs from the guess that it followed from.
  void compare(tess::Callback<Residual> result);
  /// Corrects the guess by the residual times a factor.
  void correct(double factor);
  void balance(tess::Callback<Balance> result);
  void measure(double time, tess::Callback<Measured> result);

  /// Entry method: a neighbour's row of points.
  struct Row {
    std::int32_t number = 0;  // of the small step; -1: of the guess
    bool is_before = false;
    std::vector<double> values{};
  };
  void receive(Row row);

  // What the couplings call: displacements of all points here, and forces on those owned.
  [[nodiscard]] tess::m2m::MeshView mesh_view() const { return strip_.view(); }
  [[nodiscard]] std::span<const double> displacement() const { return guess_; }
  [[nodiscard]] std::span<double> load() { return load_; }

  [[nodiscard]] std::array<double, 3> balance_position() const { return {double(index().x), 0, 0}; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, problem_, strip_, rows_, before_, after_, w_, v_, w_start_, v_start_, load_,
       guess_, residual_);
  }

 private:
  void send_rows(std::int32_t number);
  /// The force of the springs on a point.
  [[nodiscard]] double pull(std::size_t point) const;

  Problem problem_;
  Strip strip_;
  tess::Mailbox<&Row::number> rows_;
  std::vector<double> before_, after_;     // rows beside the piece
  std::vector<double> w_, v_;              // per point owned
  std::vector<double> w_start_, v_start_;  // where the step began
  std::vector<double> load_;               // forces, in units of mass × length / time²
  std::vector<double> guess_;              // per point
  std::vector<double> residual_;           // per point owned; empty before the first of a step
};

}  // namespace fsi
