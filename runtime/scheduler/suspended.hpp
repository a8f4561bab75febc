// The coroutines of one PE that wait for something. Kept so that a run that stands still can say
// who waits for what.
#pragma once

#include "runtime/ids.hpp"

#include <functional>
#include <list>
#include <string>

namespace tess {

class Element;
struct Action;

/// One coroutine that waits.
struct Suspended {
  Element* element = nullptr;
  const Action* action = nullptr;
  EpochId epoch{};
  std::function<std::string()> waits_for;
  void* frame = nullptr;
};

/// Entries stay where they are until they are taken out.
using SuspendedList = std::list<Suspended>;

/// Frees them all: the run ends before they do.
void end_all(SuspendedList& list);

}  // namespace tess
