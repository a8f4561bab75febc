// The end of a collection: a message to every PE, on account of the epoch that runs.
//
// On a PE the end is a message of its own, so no code of the collection runs meanwhile. The
// collection leaves the PE's table at once: whatever comes for it later is dropped, and the epochs
// that pay for it are told so (Pe::keep_early). An end that overtakes the creation waits for it.
// Elements without a coroutine that waits are destroyed there and then; with the last of the others
// the collection is freed, and this PE's part of the end is done.
#pragma once

#include "runtime/core/ids.hpp"

namespace tess {

class Collection;

/// Ends a collection on all PEs. One that has ended already stays so.
void end_collection(CollectionId id);

/// The last element of a collection that has ended is gone: it is freed once what runs is done.
void free_later(Collection& collection);

}  // namespace tess
