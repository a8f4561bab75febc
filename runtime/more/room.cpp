#include "runtime/more/room.hpp"

#include "runtime/core/check.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/queues/outbox.hpp"

namespace tess::detail {
namespace {

/// A message that passes through the queue of another PE of this process and returns.
struct Visit {
  PeId from;
  void* frame = nullptr;
  template <class Ar>
  void serialize(Ar& /*ar*/) {
    TESS_CHECK(false, "a suspended coroutine cannot leave its PE");
  }
};

void visit_returns(Pe& /*pe*/, Visit&& visit) {
  resume_later(Task::Handle::from_address(visit.frame));
}
void visit_arrives(Pe& pe, Visit&& visit) {
  send_system<&visit_returns>(pe, visit.from, visit);
}

}  // namespace

bool RoomAwait::await_ready() const {
  Pe& pe = current_pe();
  if (pe.machine().same_process(pe.id(), to_)) return false;
  const ProcessId process = pe.machine().process_of(to_);
  return pe.peers().outbox().has_room(process) && !pe.peers().outbox().awaited(process);
}

void RoomAwait::await_suspend(Task::Handle task) const {
  Pe& pe = current_pe();
  suspend(task, [to = to_] { return text("room for a message to ", to); });
  if (to_ == pe.id()) {
    resume_later(task);  // behind what is in the queue
  } else if (pe.machine().same_process(pe.id(), to_)) {
    send_system<&visit_arrives>(pe, to_, Visit{pe.id(), task.address()});
  } else {
    pe.peers().outbox().wait_for_room(pe.machine().process_of(to_), [task] { resume_later(task); });
  }
}

}  // namespace tess::detail

namespace tess {

bool has_room(PeId to) {
  Pe& pe = current_pe();
  return pe.machine().same_process(pe.id(), to) ||
         pe.peers().outbox().has_room(pe.machine().process_of(to));
}

}  // namespace tess
