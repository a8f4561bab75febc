// Collects the integrals of a field over the cells of the pieces of an array. A term is of one cell
// and corner, and depends on no piece; terms add up exactly, so the integrals do not depend on how
// the mesh is cut.
#pragma once

#include "m2m/mesh_view.hpp"
#include "runtime/core/exact_sum.hpp"
#include "runtime/runtime.hpp"

#include <span>
#include <utility>
#include <vector>

namespace tess::m2m {

struct IntegralPage {
  std::vector<ExactSum> integrals{};  ///< per component
  std::vector<double> magnitudes{};   ///< of |value|, to rounding: per component
  double cells = 0;                   ///< the volume or area of the cells
  double points = 0;                  ///< the same, by the cells around the points that have values

  IntegralPage& operator+=(const IntegralPage& other);
};
struct JoinIntegrals {
  IntegralPage operator()(IntegralPage a, const IntegralPage& b) const {
    a += b;
    return a;
  }
};

/// Integrates over one piece. `values`: a row per point, or per point that the piece owns; these are
/// integrated by the cells around them.
[[nodiscard]] IntegralPage integrals_of(const MeshView& mesh, std::span<const double> values);

class IntegralBook : public Group<IntegralBook> {
 public:
  /// Called by pieces on this PE.
  void add(const IntegralPage& page) { page_ += page; }
  /// Entry method: gives the sums of all PEs since the last call.
  void close_page(Callback<IntegralPage> target) {
    contribute(JoinIntegrals{}, std::exchange(page_, {}), std::move(target));
  }

 private:
  IntegralPage page_;
};

}  // namespace tess::m2m
