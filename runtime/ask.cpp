#include "runtime/ask.hpp"

#include "runtime/core/check.hpp"
#include "runtime/pe/runtime.hpp"

namespace tess::detail {

AskBase::AskBase(AskBase&& other) noexcept
    : failure_(std::move(other.failure_)),
      pe_(other.pe_),
      id_(std::exchange(other.id_, 0)),
      timer_(std::exchange(other.timer_, 0)),
      limit_(other.limit_) {
  TESS_CHECK(other.waiting_ == nullptr, "an ask is moved while a coroutine waits for it");
  if (id_ == 0) return;
  require_here();
  pe_->futures().move(id_, this);
}

void AskBase::await_suspend(Task::Handle task) {
  own_.start(task, 1);
  wait(own_);
  suspend_on(task, *this);
}

void AskBase::wait(Waiter& waiter) {
  TESS_CHECK(id_ != 0, "an ask that was cancelled or moved from is awaited");
  TESS_CHECK(waiting_ == nullptr, "two coroutines await one ask");
  require_here();
  waiting_ = &waiter;
}

AskBase* AskBase::take(Pe& pe, std::uint64_t id) {
  auto* ask = static_cast<AskBase*>(pe.futures().find(id));
  if (ask == nullptr) ++pe.statistics().late_replies;
  return ask;
}

WaitReason AskBase::reply_of(CollectionId of, std::uint64_t hash, std::string name) {
  WaitReason reason("the reply of " + name);
  reason.asked.push_back({reply_key(of, hash), std::move(name)});
  return reason;
}

void AskBase::set_deadline(Time limit) {
  if (id_ == 0) return;  // the reply is there
  require_here();
  limit_ = limit;
  if (timer_ != 0) pe_->timers().cancel(timer_);
  timer_ = pe_->timers().after(limit, [pe = pe_, id = id_] {
    if (auto* ask = static_cast<AskBase*>(pe->futures().find(id)); ask != nullptr) ask->expire();
  });
}

void AskBase::expire() {
  timer_ = 0;
  failure_ = Failure{ErrorCode::environment,
                     text(waits_for().text, " did not come within ",
                          std::chrono::duration<double, std::milli>(limit_).count(),
                          " ms: allow more time, or catch this error")};
  if (Waiter* waiter = done(); waiter != nullptr) waiter->wake();
}

/// Another thread runs the PE that knows it.
void AskBase::require_here() const {
  TESS_CHECK(pe_ == &current_pe(), "an ask of ", pe_->id(), " is used on ", current_pe().id(),
             ": its element has migrated before the reply was there; make it a local variable of "
             "the coroutine that awaits it");
}

void AskBase::leave() {
  if (id_ == 0 && timer_ == 0) return;
  if (const Pe* const here = current_pe_or_null(); here != pe_) [[unlikely]] {
    if (here == nullptr || here->stopped()) return;  // the run is over
    require_here();
  }
  if (id_ != 0) pe_->futures().leave(std::exchange(id_, 0));
  if (timer_ != 0) pe_->timers().cancel(std::exchange(timer_, 0));
}

}  // namespace tess::detail
