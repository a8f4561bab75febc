// tess::Task: the result type of an entry method that may wait. It runs immediately up to the first
// co_await that is not ready; when the awaited result is there, the coroutine is put back into the
// queue of its PE. While a coroutine waits, its element neither migrates nor ends, and its epoch is
// not done. Only named member functions (and the function passed to run()) may be coroutines.
#pragma once

#include "runtime/scheduler/block.hpp"

#include <concepts>
#include <coroutine>
#include <cstddef>
#include <exception>
#include <functional>
#include <type_traits>
#include <utility>

namespace tess {

namespace detail {

/// The context of a coroutine: the element and epoch that are restored when it continues.
struct TaskAccount {
  Pe* pe = nullptr;
  Context context;
  bool held = false;  // the coroutine waits, and holds the element and the epoch
  Suspended entry;

  void belongs_to(const Element& element);
  void hold();
  void release();

 private:
  static void pin(Element& element);
  static void unpin(Element& element);
};

}  // namespace detail

class [[nodiscard]] Task {
 public:
  struct promise_type {
    /// Frames are allocated from the pool of the PE.
    static void* operator new(std::size_t n_bytes) {
      return detail::allocate_block(current_pe(), n_bytes);
    }
    static void operator delete(void* frame, std::size_t n_bytes) {
      detail::release_block(frame, n_bytes);
    }

    detail::TaskAccount account;
    std::coroutine_handle<promise_type> parent;
    std::exception_ptr error;

    promise_type();
    /// A member function of an element: the coroutine is that element's, also if other code calls
    /// it as an object. (The class of a lambda is not complete yet, and g++ 12 deduces a
    /// reference.)
    template <class Object, class... Arguments>
      requires std::convertible_to<std::remove_reference_t<Object>*, const detail::TessElement*>
    explicit promise_type(Object& object, Arguments&... /*unused*/) : promise_type() {
      if (account.context.element != &object) account.belongs_to(object);
    }
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
  /// A waiting task continues by itself, for its element. (The destructor does not throw: g++ 12
  /// fails on a coroutine whose result type throws.)
  ~Task();

  // A task may await another: the parent continues, through the queue, when the child is done.
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

/// For awaitables: suspends a coroutine and records what it waits for. The awaitable resumes it
/// through resume_later().
void suspend(Task::Handle task, std::function<detail::WaitReason()> waits_for);

namespace detail {
/// A suspended coroutine, and the number of results that it waits for before it continues: one; all
/// of several (when_all); or the first of several (when_any), where the later ones have no effect.
class Waiter {
 public:
  void start(Task::Handle task, std::ptrdiff_t n_results) {
    task_ = task;
    n_left_ = n_results;
  }
  /// A result is there.
  void wake();
  /// The same at the end of a message of the runtime: without a message of its own.
  void wake_at_end();

 private:
  Task::Handle task_;
  std::ptrdiff_t n_left_ = 0;
};
}  // namespace detail

/// Puts a suspended coroutine into the queue of its PE; must be called on that PE.
void resume_later(Task::Handle task);

}  // namespace tess
