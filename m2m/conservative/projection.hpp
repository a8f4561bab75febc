// Conservative L2 (Galerkin) projection onto linear elements: the target field whose integral
// against every basis function equals that of the source field,
//
//     M u = load,  load_i = integral of u_source psi_i          (loads.hpp, mass_matrix.hpp)
//
// so the integral of the field is conserved. Three forms:
//
//   lumped       u_i = load_i / m_i, m_i the row sum of M. Bounded by the values of the source, but
//                it smooths: first order near extrema.
//   consistent   M u = load by conjugate gradients. Second order; over- and undershoots at jumps.
//   bounded      lumped, plus as much of the difference to consistent as the bounds allow (flux
//                correction: Zalesak 1979; Löhner, Morgan, Peraire and Vahdati 1987; Kuzmin, Möller
//                and Turek 2003; for projections Farrell et al. 2009). Conserves, too.
//
// The solver knows no messages. step() computes until it needs something from the other parts, and
// says what. The caller provides it, now or later, and calls step() again:
//
//     Projection solver(mass, n_owned, 1, load, Projection::Form::consistent);
//     for (auto need = solver.step(); need != Projection::Need::nothing; need = solver.step()) {
//       if (need == Projection::Need::copies) …  add rows() over the copies of each vertex
//       if (need == Projection::Need::parts) …   add scalars() over all parts
//     }
//     use(solver.values());
//
// A mesh in one part needs neither. Every part takes the same steps. Costs one exchange of rows and
// one sum per iteration (Chronopoulos and Gear 1989), about 30 iterations for 1e-15 on any mesh: with
// the diagonal as preconditioner all eigenvalues lie in [1/2, 5/2] (Wathen 1987).
#pragma once

#include "m2m/conservative/mass_matrix.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

class Projection {
 public:
  enum class Form : std::uint8_t { lumped, consistent, bounded };
  enum class Need : std::uint8_t { copies, parts, nothing };

  /// `mass` must outlive the solver. The first `n_owned` vertices are owned by this part, the others
  /// are ghosts. `load`: n_points × n_components, row-major; every copy of a vertex has the whole
  /// load. `bounds`: of the source values that contribute, in the same shape and the same on all
  /// copies (value_ranges() in rows.hpp); only for Form::bounded.
  Projection(const MassMatrix& mass, std::size_t n_owned, std::size_t n_components,
             std::vector<double> load, Form form, std::vector<ValueRange> bounds = {});

  [[nodiscard]] Need step();
  /// What the caller adds over the copies of each vertex, in place: n_points rows.
  [[nodiscard]] std::span<double> rows() noexcept { return rows_; }
  [[nodiscard]] std::size_t n_columns() const noexcept { return rows_.size() / mass_.n_points(); }
  /// What the caller adds over all parts, in place; the order of addition changes the last bits.
  [[nodiscard]] std::span<double> scalars() noexcept { return scalars_; }

  /// The result, n_points × n_components; the same on all copies. A vertex that is not covered
  /// (lumped_mass 0) has the value 0.
  [[nodiscard]] std::span<const double> values() const noexcept { return x_; }
  /// Row sums of M, added over the copies. Integral of the field: sum of lumped_mass × value over
  /// the owned vertices.
  [[nodiscard]] std::span<const double> lumped_mass() const noexcept { return lumped_; }
  [[nodiscard]] std::size_t n_iterations() const noexcept { return n_iterations_; }

 private:
  enum class Stage : std::uint8_t {
    start,
    diagonals,
    product,
    reduction,
    closing,
    fluxes,
    limited,
    done
  };

  [[nodiscard]] Need request_product(std::span<const double> x, Stage next);
  [[nodiscard]] Need after_diagonals();
  [[nodiscard]] Need after_product();
  [[nodiscard]] Need after_reduction();
  [[nodiscard]] Need after_closing();
  [[nodiscard]] Need after_fluxes();
  [[nodiscard]] Need after_limited();
  [[nodiscard]] Need finish();
  template <class Visit>
  void for_each_flux(Visit&& visit) const;

  const MassMatrix& mass_;
  std::size_t n_owned_;
  std::size_t n_;  // components
  Form form_;
  Stage stage_ = Stage::start;
  bool first_product_ = true;
  std::size_t n_iterations_ = 0;

  std::vector<double> load_, x_, lumped_, inverse_diagonal_;
  std::vector<ValueRange> bounds_;
  std::vector<double> residual_, z_, p_, s_;         // of conjugate gradients
  std::vector<double> gamma_, alpha_, first_gamma_;  // per component
  std::vector<double> low_order_;                    // the lumped solution
  std::vector<ValueRange> ratios_;                   // of admissible to wanted fluxes
  std::vector<double> rows_, scalars_;
};

}  // namespace tess::m2m
