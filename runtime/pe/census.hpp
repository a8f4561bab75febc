// What waits on a PE, for the reports of a deadlock, a hang and a signal.
#pragma once

#include <span>

namespace tess::detail {

class Pe;
struct Waits;

/// What waits on this PE for something from elsewhere. Coroutines with these frames are left out.
[[nodiscard]] Waits census(Pe& pe, std::span<void* const> except = {});
/// Reports also what is about to run, while the run goes on.
[[nodiscard]] Waits census_of_running(Pe& pe);

}  // namespace tess::detail
