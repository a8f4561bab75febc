// Flow control: a producer waits until its earlier messages have been processed, so that only a
// little of its output is in memory.
//
//     for (const Tile& tile : tiles) {
//       co_await tess::room(sink[{0}]);
//       sink[{0}].send<&Sink::take>(render(tile));
//     }
//
// There is room to another process if no messages to it are held back (--message-memory). Producers
// of a PE that wait for the same process continue one after the other. Within a process there is
// room once the destination's PE has reached this point of its queue.
#pragma once

#include "runtime/task.hpp"

namespace tess {

namespace detail {

class [[nodiscard]] RoomAwait {
 public:
  explicit RoomAwait(PeId to) : to_(to) {}

  [[nodiscard]] bool await_ready() const;
  void await_suspend(Task::Handle task) const;
  void await_resume() const noexcept {}

 private:
  PeId to_;
};

}  // namespace detail

/// True if no messages from this PE to the process of that PE are held back. Within a process
/// nothing is ever held back.
[[nodiscard]] bool has_room(PeId to);

/// When awaited, completes once there is room for a message to this PE.
[[nodiscard]] inline detail::RoomAwait room(PeId to) {
  return detail::RoomAwait(to);
}
/// Completes likewise for a message to an element or a group's member: array[index], group[pe].
template <class Proxy>
[[nodiscard]] detail::RoomAwait room(const Proxy& to)
  requires requires { to.next_pe(); }
{
  return detail::RoomAwait(to.next_pe());
}

}  // namespace tess
