#include "runtime/scheduler/suspended.hpp"

#include <coroutine>
#include <vector>

namespace tess {

void end_all(SuspendedList& list) {
  // Those that no Task holds: with a frame end the tasks that it holds.
  std::vector<void*> roots;
  for (const Suspended* one = list.first(); one != nullptr; one = one->after)
    if (*one->detached) roots.push_back(one->frame);
  list.clear();
  for (void* frame : roots) std::coroutine_handle<>::from_address(frame).destroy();
}

}  // namespace tess
