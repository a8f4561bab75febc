// tess::Task: an entry method that may wait. It runs at once, up to the first co_await that is not
// ready; what it waits for puts it back into the queue of its PE. While it waits its element
// neither migrates nor ends, and the epoch that called it is not done. Only named member functions
// (and the function given to run()) are coroutines.
#pragma once

#include "runtime/scheduler/block.hpp"

#include <coroutine>
#include <exception>
#include <functional>
#include <string>
#include <utility>

namespace tess {

/// What a coroutine belongs to: the element and epoch that are restored when it goes on.
struct TaskAccount {
  Pe* pe = nullptr;
  Context context;
  bool held = false;  // it waits: the element and the epoch are held
  Suspended entry;

  void hold();
  void release();

 private:
  static void pin(Element& element);
  static void unpin(Element& element);
};

class [[nodiscard]] Task {
 public:
  struct promise_type {
    /// Frames come from the pool of the PE.
    static void* operator new(std::size_t n_bytes) { return allocate_block(current_pe(), n_bytes); }
    static void operator delete(void* frame, std::size_t n_bytes) { release_block(frame, n_bytes); }

    TaskAccount account;
    std::coroutine_handle<promise_type> parent;
    std::exception_ptr error;

    promise_type();
    Task get_return_object() {
      return Task(std::coroutine_handle<promise_type>::from_promise(*this));
    }
    std::suspend_never initial_suspend() noexcept { return {}; }
    struct Final {
      bool await_ready() noexcept { return false; }
      void await_suspend(std::coroutine_handle<promise_type> self) noexcept;
      void await_resume() noexcept {}
    };
    Final final_suspend() noexcept { return {}; }
    void return_void() noexcept {}
    void unhandled_exception() { error = std::current_exception(); }
    bool detached = false;
  };
  using Handle = std::coroutine_handle<promise_type>;

  Task(Task&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;
  Task& operator=(Task&&) = delete;
  /// A task that waits goes on by itself, on its element's account.
  /// (It does not throw: g++ 12 fails on a coroutine whose result does.)
  ~Task();

  // A task may await another: the parent goes on, through the queue, when the child is done.
  [[nodiscard]] bool await_ready() const noexcept { return handle_.done(); }
  void await_suspend(Handle parent);
  void await_resume() {
    if (handle_.promise().error)
      std::rethrow_exception(std::exchange(handle_.promise().error, nullptr));
  }

 private:
  explicit Task(Handle handle) : handle_(handle) {}
  Handle handle_;
};

/// Suspends a coroutine and says what for; whoever has it resumes it through resume_later(). For
/// awaitables.
void suspend(Task::Handle task, std::function<std::string()> waits_for);

/// Puts a suspended coroutine into the queue of its PE; call it on that PE.
void resume_later(Task::Handle task);

}  // namespace tess
