// Epochs: a coroutine waits until all consequences of some work are done.
//
//     co_await tess::epoch([&] { blocks.broadcast<&Block::step>(0); });
//
// The body runs immediately, on this PE. The coroutine continues when everything that the body
// caused is done: every message it sent, every message that those sent, and so on, on every PE,
// including coroutines that wait. Epochs nest, and several may run at once; each counts its own
// messages.
#pragma once

#include "runtime/task.hpp"

#include <exception>
#include <utility>

namespace tess {

namespace detail {

template <class Body>
class [[nodiscard]] EpochAwait {
 public:
  explicit EpochAwait(Body body) : body_(std::move(body)) {}

  [[nodiscard]] bool await_ready() const noexcept { return false; }
  void await_suspend(Task::Handle task) {
    suspend(task, [this] { return waits_for(); });
    begin([task] { resume_later(task); });
  }
  [[nodiscard]] bool failed() const { return error_ != nullptr; }
  void await_resume() const {
    if (error_) std::rethrow_exception(error_);
  }
  [[nodiscard]] std::string waits_for() const {
    return text("epoch ", id_.value >> 24U, " that it opened");
  }
  /// Runs the body; calls `done` on this PE once all its consequences are done.
  template <class Done>
  void begin(const Done& done) {
    Pe& pe = current_pe();
    const EpochId outer = pe.context().epoch;
    const EpochId epoch = id_ = pe.completion().open(outer, done);
    pe.context().epoch = epoch;
    try {
      body_();
    } catch (...) {
      error_ = std::current_exception();  // rethrown in the coroutine once the started work is done
    }
    pe.context().epoch = outer;
    pe.completion().close(epoch);
  }

 private:
  Body body_;
  EpochId id_{};
  std::exception_ptr error_;
};

}  // namespace detail

/// When awaited, runs `body` and completes once all its consequences are done.
template <class Body>
[[nodiscard]] detail::EpochAwait<Body> epoch(Body body) {
  return detail::EpochAwait<Body>(std::move(body));
}

}  // namespace tess
