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
#include <functional>
#include <string>
#include <utility>

namespace tess {

namespace detail {

/// What awaited epochs have in common; the type of the body is left out.
class EpochBase {
 public:
  [[nodiscard]] bool await_ready() const noexcept { return false; }
  [[nodiscard]] bool failed() const { return error_ != nullptr; }
  void await_resume() const {
    if (error_) std::rethrow_exception(error_);
  }
  [[nodiscard]] std::string waits_for() const;

 protected:
  using Run = void (*)(EpochBase&);
  void suspend_until_done(Task::Handle task, Run body);
  void begin(Run body, std::function<void()> done);

 private:
  EpochId id_{};
  std::exception_ptr error_;
};

template <class Body>
class [[nodiscard]] EpochAwait : public EpochBase {
 public:
  explicit EpochAwait(Body body) : body_(std::move(body)) {}

  void await_suspend(Task::Handle task) { suspend_until_done(task, &run); }
  /// Runs the body; calls `done` on this PE once all its consequences are done.
  void begin(std::function<void()> done) { EpochBase::begin(&run, std::move(done)); }

 private:
  static void run(EpochBase& of) { static_cast<EpochAwait&>(of).body_(); }
  Body body_;
};

/// Runs `body` at the end of the expression that makes it. If it is awaited, it runs then, and the
/// coroutine continues when all consequences of it are done, as those of an epoch().
template <class Body>
class Deed {
 public:
  explicit Deed(Body body) : body_(std::move(body)) {}
  Deed(const Deed&) = delete;
  Deed& operator=(const Deed&) = delete;
  ~Deed() {
    if (!awaited_) body_();
  }
  [[nodiscard]] EpochAwait<Body> operator co_await() {
    awaited_ = true;
    return EpochAwait<Body>(body_);
  }

 private:
  Body body_;
  bool awaited_ = false;
};

}  // namespace detail

/// When awaited, runs `body` and completes once all its consequences are done.
template <class Body>
[[nodiscard]] detail::EpochAwait<Body> epoch(Body body) {
  return detail::EpochAwait<Body>(std::move(body));
}

}  // namespace tess
