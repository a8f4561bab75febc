#include "runtime/epoch.hpp"

#include "runtime/core/text.hpp"
#include "runtime/pe/pe.hpp"

namespace tess::detail {

std::string EpochBase::waits_for() const {
  return text("epoch ", id_.value >> 24U, " that it opened");
}

void EpochBase::suspend_until_done(Task::Handle task, Run body) {
  suspend_on(task, *this);
  begin(body, [task] { resume_later(task); });
}

void EpochBase::begin(Run body, std::function<void()> done) {
  Pe& pe = current_pe();
  const EpochId outer = pe.context().epoch;
  const EpochId epoch = id_ = pe.completion().open(outer, std::move(done));
  pe.context().epoch = epoch;
  try {
    body(*this);
  } catch (...) {
    error_ = std::current_exception();  // rethrown in the coroutine once the started work is done
  }
  pe.context().epoch = outer;
  pe.completion().close(epoch);
}

}  // namespace tess::detail
