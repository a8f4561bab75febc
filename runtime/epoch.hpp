// co_await tess::epoch(body): runs body now, on this PE, and goes on when all that it caused is
// done: every message it sent, every message those sent, and so on, wherever they went, coroutines
// that wait included. Epochs nest, and several run at once; each counts its own messages.
#pragma once

#include "runtime/task.hpp"

#include <utility>

namespace tess {

template <class Body>
class [[nodiscard]] EpochAwait {
 public:
  explicit EpochAwait(Body body) : body_(std::move(body)) {}

  [[nodiscard]] bool await_ready() const noexcept { return false; }
  void await_suspend(Task::Handle task) {
    Pe& pe = current_pe();
    const EpochId outer = pe.context().epoch;
    const EpochId epoch = pe.completion().open(outer, [task] { resume_later(task); });
    suspend(task, [epoch] { return text("epoch ", epoch.value >> 24U, " that it opened"); });
    pe.context().epoch = epoch;
    try {
      body_();
    } catch (...) {
      error_ = std::current_exception();  // for the coroutine, when what the body began is done
    }
    pe.context().epoch = outer;
    pe.completion().close(epoch);
  }
  void await_resume() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  Body body_;
  std::exception_ptr error_;
};

/// Awaited, runs `body` and is done when all that it caused is done.
template <class Body>
[[nodiscard]] EpochAwait<Body> epoch(Body body) {
  return EpochAwait<Body>(std::move(body));
}

}  // namespace tess
