#include "runtime/checkpoint/quiet.hpp"

#include "runtime/core/text.hpp"
#include "runtime/pe/pe_action.hpp"

#include <utility>

namespace tess::detail {

Thaw thaw_here(Pe& pe, const Thaw& done) {
  pe.timers().thaw();
  return done;
}

Quiet::~Quiet() {
  if (id_ != 0) pe_.futures().leave(id_);
}

void Quiet::await_suspend(Task::Handle task) {
  task_ = task;
  id_ = pe_.futures().enter(this);
  suspend(task, [] { return std::string("the end of all messages, for a checkpoint"); });
  hold_.emplace(pe_.completion());
  ask();
}

void Quiet::ask() {
  n_left_ = pe_.n_pes();
  processed_before_ = std::exchange(n_processed_, 0);
  n_sent_ = 0;
  reports_ = false;
  for (std::int32_t to = 0; to < pe_.n_pes(); ++to)
    send_uncounted<&Quiet::asked>(pe_, PeId{to}, Asked{id_, pe_.id()});
}

void Quiet::asked(Pe& pe, Asked&& m) {
  pe.timers().freeze();
  // A report that is due belongs to no message.
  const bool reports = pe.completion().report_epochs();
  send_uncounted<&Quiet::answered>(
      pe, m.from,
      Answered{m.id, pe.id(), reports, pe.completion().run_sent(), pe.completion().run_processed(),
               pe.timers().n_waiting()});
}

void Quiet::answered(Pe& pe, Answered&& m) {
  if (auto* const quiet = static_cast<Quiet*>(pe.futures().find(m.id)); quiet != nullptr)
    quiet->take(m);
}

void Quiet::take(const Answered& answer) {
  n_sent_ += answer.n_sent;
  n_processed_ += answer.n_processed;
  reports_ = reports_ || answer.reports;
  if (answer.n_timers != 0)
    timers_.push_back(text(answer.n_timers, answer.n_timers == 1 ? " timer is" : " timers are",
                           " set on ", answer.from));
  if (--n_left_ != 0) return;
  if (timers_.empty() && (reports_ || n_sent_ != processed_before_ + 1)) {
    ask();
    return;
  }
  resume_later(task_);
  hold_.reset();
}

}  // namespace tess::detail
