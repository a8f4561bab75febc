#include "runtime/pe/tables/suspended.hpp"

#include <coroutine>
#include <vector>

namespace tess::detail {

void end_all(SuspendedList& list) {
  // Only the frames that no Task holds: destroying a frame also destroys the tasks that it holds.
  std::vector<void*> roots;
  for (const Suspended* one = list.first(); one != nullptr; one = one->after)
    if (*one->detached) roots.push_back(one->frame);
  list.clear();
  for (void* frame : roots) std::coroutine_handle<>::from_address(frame).destroy();
}

}  // namespace tess::detail
