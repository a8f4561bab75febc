// Scaled consistent transfers: values by the rows of a coupling, and then each component times the
// number that gives the target the integral of the source.
//
//     co_await apply_scaled<&Fluid::flux, &Solid::flux>(to_solid);
//
// So the shape of the field stays smooth, where a conservative kind would need overlapping cells,
// and the total is kept: of fluxes or sources over two walls that differ a little.
#pragma once

#include "m2m/coupling.hpp"

#include <vector>

namespace tess::m2m {

/// Integrals over the cells of both meshes, per component, before values are scaled.
struct FieldIntegrals {
  std::vector<double> source, target;
};

namespace detail {
/// Integrates both sides after an application, and scales the target.
TaskOf<FieldIntegrals> scale(AnyCoupling coupling, Giver give, Taker take);
}  // namespace detail

/// Does apply<Give, Take>() (coupling.hpp), and then scales what each piece took. received() is
/// called before that. Points that the policy leaves alone count and are scaled, too. The integral
/// is of the values at points, linear in each cell (volumes, areas of triangles). Pieces of the
/// target show a halo of one layer of cells (MeshView::n_own_tets), unless they take values for all
/// of their points.
///
/// Throws Error (bad_value), and leaves the values as apply() wrote them, if an integral of the
/// target is 0 to rounding, but not the source's; (bad_mesh) if the halo is missing or there are no
/// cells; (bad_argument) if values are not in nodes.
template <auto Give, auto Take, class S, class T>
TaskOf<FieldIntegrals> apply_scaled(Coupling<S, T> coupling) {
  co_await coupling.template apply<Give, Take>();
  co_return co_await detail::scale(coupling, detail::Giver(detail::GiverOf<S, Give>::kind),
                                   detail::Taker(detail::TakerOf<T, Take>::kind));
}

}  // namespace tess::m2m
