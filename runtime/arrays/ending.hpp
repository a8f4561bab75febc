// The end of a collection: a message to every PE, in the current epoch.
//
// On each PE the end is a separate message, so no code of the collection runs meanwhile. The
// collection leaves the PE's table at once: messages that arrive later are dropped, and their
// epochs are settled (HostedCollections::keep_early). An end that overtakes the creation waits for it. Elements
// without a waiting coroutine are destroyed immediately. Once the last other element is destroyed
// the collection is freed, and this PE's part of the end is done.
#pragma once

#include "runtime/core/ids.hpp"

namespace tess::detail {

class Collection;

/// Ends a collection on all PEs. Ending it again has no effect.
void end_collection(CollectionId id);

/// A message to every PE, in the current epoch, that waits there until the collection is known.
void wait_everywhere(CollectionId id);

/// True on a PE of a run that has not begun to end. Otherwise a destructor need not end anything.
[[nodiscard]] bool in_running_program();

/// The last element of an ended collection is gone: frees the collection after the running code.
void free_later(Collection& collection);

}  // namespace tess::detail
