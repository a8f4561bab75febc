// co_await tess::room(to): a producer waits until what it sent has been worked off, so that it
// keeps only a little of its output in memory.
//
//     for (const Tile& tile : tiles) {
//       co_await tess::room(sink[{0}]);
//       sink[{0}].send<&Sink::take>(render(tile));
//     }
//
// To another process there is room while messages are not held back there (--message-memory). The
// producers of a PE that wait for one process go on one after the other. Within a process there is
// room once the destination's PE has come to this point of its queue.
#pragma once

#include "runtime/task.hpp"

namespace tess {

class [[nodiscard]] RoomAwait {
 public:
  explicit RoomAwait(PeId to) : to_(to) {}

  [[nodiscard]] bool await_ready() const;
  void await_suspend(Task::Handle task) const;
  void await_resume() const noexcept {}

 private:
  PeId to_;
};

/// Awaited, is done when there is room for a message to that PE.
[[nodiscard]] inline RoomAwait room(PeId to) {
  return RoomAwait(to);
}
/// The same for a message to an element, or to a member of a group: array[index], group[pe].
template <class Proxy>
[[nodiscard]] RoomAwait room(const Proxy& to)
  requires requires { to.next_pe(); }
{
  return RoomAwait(to.next_pe());
}

}  // namespace tess
