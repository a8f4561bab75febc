// A flexible panel in the floor of a channel. The panel is the unit square z = 0, held at its edges:
// a membrane of mass m per area under a tension T. Above it an ideal fluid of density ρ stands to
// the height H. The motion of the first mode,
//
//     w = q(t) sin πx sin πy,     k = π √2,
//
// moves the fluid by a potential, whose pressure on the panel is that of an added mass:
//
//     p = - m_a ∂²w/∂t²,          m_a = ρ coth(k H) / k.
//
// So the panel swings as if it were heavier, q = a cos ωt with ω² = 2 π² T / (m + m_a), and no energy
// is lost. A light panel in a dense fluid, m_a > m, is the stiff case of such codes: they correct
// each other's result by more than it changed.
#pragma once

#include "collide/box.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace fsi {

using tess::collide::Point;

struct Problem {
  std::int32_t n_panel = 16;  ///< squares on an edge of the panel's mesh
  std::int32_t n_flow = 0;    ///< and of the fluid's wall; 0: half as many again, and one
  std::int32_t n_pieces = 0;  ///< of each mesh; 0: two per PE
  double mass = 1, tension = 1, density = 5, height = 1, amplitude = 0.01;
  std::int32_t per_period = 40;  ///< steps in a period of the exact motion
  std::int32_t n_steps = 50;     ///< from rest at the greatest displacement
  std::int32_t n_substeps = 0;   ///< of the panel in a step; 0: as many as are stable

  // How panel and fluid are brought to agree in a step.
  double relaxation = 0.5;  ///< of the first correction of all
  bool adapts = true;       ///< the factor of the others is Aitken's, not the first one's
  std::int32_t most_iterations = 100;
  double tolerance = 1e-10;  ///< of the amplitude

  /// Chooses what is 0. Throws tess::Error (bad_argument) for what cannot be computed.
  void complete(std::int32_t n_pes);

  [[nodiscard]] double added_mass() const;  ///< per area
  [[nodiscard]] double frequency() const;   ///< ω
  [[nodiscard]] double dt() const { return 2 * std::numbers::pi / (frequency() * per_period); }
  [[nodiscard]] double exact(const Point& p, double time) const {
    return amplitude * std::cos(frequency() * time) * std::sin(std::numbers::pi * p[0]) *
           std::sin(std::numbers::pi * p[1]);
  }
};

}  // namespace fsi
