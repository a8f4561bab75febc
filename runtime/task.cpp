#include "runtime/task.hpp"

#include "runtime/arrays/collection.hpp"
#include "runtime/core/check.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/report/pe_watch.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <pthread.h>

namespace tess {
namespace detail {
namespace {

/// The lowest address of this thread's stack to which calls may go, and 256 KiB above its end, or a
/// quarter of a small stack: the room for what a task calls. 0 if the system does not say.
std::uintptr_t lowest_call() {
  constexpr std::size_t room_bytes = std::size_t{256} << 10U;
  pthread_attr_t attributes;
  void* end = nullptr;
  std::size_t n_bytes = 0;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return 0;
  const bool known = pthread_attr_getstack(&attributes, &end, &n_bytes) == 0;
  pthread_attr_destroy(&attributes);
  return known ? reinterpret_cast<std::uintptr_t>(end) + std::min(room_bytes, n_bytes / 4) : 0;
}

/// A coroutine handle in the queue of its own PE, which it never leaves.
struct Resumption {
  void* frame = nullptr;
  template <class Ar>
  void serialize(Ar& /*ar*/) {
    TESS_CHECK(false, "a suspended coroutine cannot leave its PE");
  }
};

/// Nothing else of the program runs on this PE; the message under way ends with it.
void resume(Task::Handle task) {
  Pe& pe = *task.promise().account.pe;
  TaskAccount& account = task.promise().account;
  const Context context = account.context;
  if (context.element == nullptr) {
    account.release();
    pe.begins(context.action);  // other threads look at it
    pe.context().element = nullptr;
    pe.context().epoch = context.epoch;
    pe.context().led_by = context.led_by;
    pe.context().led_in = context.led_in;
    const MainScope scope(pe);
    task.resume();
    return;
  }
  pe.begins(context.action);
  const ElementScope scope(pe, *context.element, context.action, context.epoch, context.led_by);
  account.release();
  task.resume();
}

void run_resumption(Pe& /*pe*/, Resumption&& resumption) {
  resume(Task::Handle::from_address(resumption.frame));
}

}  // namespace

void refuse_deep_calls() {
  thread_local const std::uintptr_t lowest = lowest_call();
  TESS_CHECK(reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0)) >= lowest,
             "tasks call tasks so deep that the stack of this PE ends: call the next one after a "
             "co_await, or in a loop, or send it to an element (ulimit -s gives more)");
}

void TaskAccount::belongs_to(const Element& element) {
  context.element = const_cast<Element*>(&element);
  context.led_by = 0;
}

void TaskAccount::hold() {
  if (held) return;
  held = true;
  Counted::departs(pe->completion(), context.epoch);
  if (context.element != nullptr) pin(*context.element);
}

void TaskAccount::release() {
  if (!held) return;
  held = false;
  pe->suspended().erase(entry);
  (void)Counted(pe->completion(), context.epoch);
  if (context.element != nullptr) unpin(*context.element);
}

void TaskAccount::pin(Element& element) {
  ++element.n_suspended_;
}
void TaskAccount::unpin(Element& element) {
  --element.n_suspended_;
}

TaskPromise::TaskPromise() {
  account.pe = &current_pe();
  account.context = account.pe->context();
}

}  // namespace detail

void suspend(Task::Handle task, std::function<detail::WaitReason()> waits_for) {
  detail::TaskAccount& account = task.promise().account;
  account.hold();
  account.entry = {account.context.element, account.context.action, account.context.epoch,
                   std::move(waits_for),    task.address(),         &task.promise().detached};
  account.pe->suspended().insert(account.entry);
}

void detail::suspend_at(Task::Handle task, void* awaitable, WaitReason (*waits_for)(void*)) {
  suspend(task, [awaitable, waits_for] { return waits_for(awaitable); });
}

void resume_later(Task::Handle task) {
  Pe& pe = *task.promise().account.pe;
  using Held = detail::Message<detail::Resumption>;
  auto* message = pe.stamp(Held::make(pe, detail::PeAction<&detail::run_resumption>::action,
                                      detail::Resumption{task.address()}));
  message->epoch = task.promise().account.context.epoch;
  pe.send_here(message);
}

}  // namespace tess

namespace tess::detail {

void Waiter::wake() {
  if (--n_left_ == 0) resume_later(task_);
}
void Waiter::wake_at_end() {
  if (--n_left_ == 0) resume(task_);
}

void TaskPromise::Final::await_suspend(TaskHandle self) noexcept {
  TaskPromise& promise = self.promise();
  if (promise.parent) {
    resume_later(promise.parent);
  } else if (promise.detached) {
    const std::exception_ptr thrown = promise.error;
    Pe& pe = *promise.account.pe;
    self.destroy();
    if (thrown) pe.error().keep(thrown);
  }
}

AnyTask::~AnyTask() {
  if (!handle_) return;
  TaskPromise& promise = handle_.promise();
  if (!handle_.done()) {
    if (promise.account.pe->dropping()) {
      handle_.destroy();
    } else {
      promise.detached = true;
    }
    return;
  }
  if (promise.error) promise.account.pe->error().keep(promise.error);
  handle_.destroy();
}

void AnyTask::await_suspend(TaskHandle parent) {
  TESS_CHECK(handle_.promise().parent == nullptr, "two coroutines await one task");
  handle_.promise().parent = parent;
  suspend(parent, [] { return std::string("a task that it called"); });
}

void refuse_second_await() {
  TESS_CHECK(false, "a task is awaited again: the first co_await took its result, so keep that");
  std::abort();
}

}  // namespace tess::detail
