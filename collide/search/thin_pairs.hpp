// The pairs of objects that have capsules, if these pay (choose_pieces.hpp).
//
//     boxes of pieces, or of objects  ->  pairs of boxes  ->  capsules may meet?  ->  first of the pair?
//
// Two objects have a common point only if two of their pieces have, so their boxes overlap. If
// several pairs of their pieces overlap, the first of them passes the pair on: the first in the
// order of the pieces of the object of the first set, or of the one with the lower position.
#pragma once

#include "collide/search/choose_pieces.hpp"

namespace tess::collide::search {

/// Finds the pairs with capsules and pieces of the given length, whether they pay or not. Throws
/// Error as for_each_pair() does.
template <class Real>
void search_thin(ThinSets<Real> sets, double longest, const PairOptions& options,
                 detail::PairSink sink);

}  // namespace tess::collide::search
