// Whether the objects of a search are so long and thin that their capsules pay, and how long pieces
// should be: by expected cost, from a sample.
#pragma once

#include "collide/problem/thin_objects.hpp"

#include <optional>

namespace tess::collide::search {

/// One set with itself, or two sets.
template <class Real>
using ThinSets = std::span<const ThinSet<Real>>;

/// The longest extent of a piece, or ThinObjects::whole; nothing if the capsules do not pay. As if
/// there were `scale` objects for each.
template <class Real>
[[nodiscard]] std::optional<double> choose_pieces(ThinSets<Real> sets, const PairOptions& options,
                                                  double scale = 1);

/// Whether pairs within a model do not count.
[[nodiscard]] inline bool divides(const PairOptions& options) {
  return !options.models.empty() && options.within_model == WithinModel::skip;
}

}  // namespace tess::collide::search
