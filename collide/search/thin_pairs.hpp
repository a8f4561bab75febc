// The pairs of objects that have capsules, if these pay (choose_pieces.hpp):
//
//     boxes of pieces, or of objects  ->  pairs of boxes  ->  pairs of objects (piece_pairs.hpp)
#pragma once

#include "collide/search/choose_pieces.hpp"

namespace tess::collide::search {

/// Finds the pairs with capsules and pieces of the given length, whether they pay or not. Throws
/// Error as for_each_pair() does.
template <class Real>
void search_thin(ThinSets<Real> sets, double longest, const PairOptions& options,
                 detail::PairSink sink);

}  // namespace tess::collide::search
