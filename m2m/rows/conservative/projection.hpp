// Conservative L2 (Galerkin) projection onto linear elements: the target field whose integral
// against every basis function equals that of the source field,
//
//     M u = load,  load_i = integral of u_source psi_i       (overlap_rows.hpp, mass_matrix.hpp)
//
// so the integral of the field is conserved. Three forms:
//
//   lumped       u_i = load_i / m_i, m_i the row sum of M. Bounded by the values of the source, but
//                it smooths: first order near extrema.
//   consistent   M u = load. Second order; over- and undershoots at jumps.
//   bounded      lumped, plus as much of the difference to consistent as the bounds allow (flux
//                correction: Zalesak 1979; Löhner, Morgan, Peraire and Vahdati 1987; Kuzmin, Möller
//                and Turek 2003; for projections Farrell et al. 2009). Conserves, too.
//
// With the diagonal as preconditioner all eigenvalues lie in [1/2, 5/2] (mass_matrix.hpp). So a
// fixed number of Chebyshev steps solves the system to the last digits (Saad 2003, section 12.3.2).
// Unlike conjugate gradients they need no sum over the mesh: a part waits only for its neighbours,
// and the result has the same bits for every partition.
//
// The solver knows no messages. step() computes until it needs values of ghosts, which their owners
// have; the caller provides them, now or later, and calls step() again:
//
//     while (solver.step(mass))
//       … copy rows of solver.shared() from owners to ghosts …
//     use(solver.values());
//
// All parts take the same steps. A NaN spreads over the connected region, except in lumped form.
#pragma once

#include "m2m/rows/conservative/mass_matrix.hpp"
#include "m2m/rows/weights/rows.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

class Projection {
 public:
  enum class Form : std::uint8_t { lumped, consistent, bounded };

  Projection() = default;
  /// `loads`: n_owned × n_components. `bounds`, in the same shape: of the source values that
  /// contribute; only for Form::bounded.
  Projection(const MassMatrix& mass, std::size_t n_components, Form form, std::vector<double> loads,
             std::vector<ValueRange> bounds = {});

  /// True if the ghosts' rows of shared() are needed; false at the end.
  [[nodiscard]] bool step(const MassMatrix& mass);
  /// Row-major, a row per point: n_columns() numbers.
  [[nodiscard]] std::span<double> shared() noexcept;
  [[nodiscard]] std::size_t n_columns() const noexcept {
    return stage_ == Stage::limit ? 2 * n_ : n_;
  }
  /// The result: n_owned × n_components. Points that are not covered have 0.
  [[nodiscard]] std::span<const double> values() const noexcept {
    return std::span(x_).first(load_.size());
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_, form_, stage_, n_steps_, factor_, load_, x_, direction_, product_, low_order_, bounds_,
       ratios_);
  }

 private:
  enum class Stage : std::uint8_t { start, iterate, fluxes, limit, done };

  void chebyshev_step(const MassMatrix& mass);
  void close(const MassMatrix& mass);
  void find_ratios(const MassMatrix& mass);
  void add_limited(const MassMatrix& mass);
  template <class Visit>
  void for_each_flux(const MassMatrix& mass, const Visit& visit) const;

  std::size_t n_ = 1;
  Form form_ = Form::lumped;
  Stage stage_ = Stage::start;
  std::uint32_t n_steps_ = 0;
  double factor_ = 0;  // rho of the recurrence
  // Rows of points owned, except x_ and ratios_: of all points.
  std::vector<double> load_, x_, direction_, product_, low_order_;
  std::vector<ValueRange> bounds_;
  std::vector<double> ratios_;  // of admissible to wanted fluxes: negative and positive ones
};

}  // namespace tess::m2m
