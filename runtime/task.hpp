// tess::Task: the result type of an entry method that may wait; tess::TaskOf<T>: of a coroutine
// that gives a value. It runs immediately up to the first co_await that is not ready; when the
// awaited result is there, the coroutine is put back into the queue of its PE. While a coroutine
// waits, its element neither migrates nor ends, and its epoch is not done. Only named functions
// (and the function passed to run()) may be coroutines.
#pragma once

#include "runtime/pe/block.hpp"

#include <concepts>
#include <coroutine>
#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
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

class TaskPromise;

/// Ends the job when the stack of this thread is nearly used up: a coroutine runs on it up to its
/// first wait, and so do those that it calls.
void refuse_deep_calls();

/// The handle of a coroutine of any type of task.
struct TaskHandle : std::coroutine_handle<TaskPromise> {
  TaskHandle() = default;
  template <std::derived_from<TaskPromise> Promise>
  TaskHandle(std::coroutine_handle<Promise> task)  // NOLINT(google-explicit-constructor)
      : std::coroutine_handle<TaskPromise>(
            std::coroutine_handle<TaskPromise>::from_address(task.address())) {
    // A frame has its promise behind two pointers, rounded up to the alignment of the promise.
    static_assert(alignof(Promise) <= 2 * sizeof(void*));
  }
};

/// What the promises of all tasks have: the first part of each.
class TaskPromise {
 public:
  /// Frames are allocated from the pool of the PE.
  static void* operator new(std::size_t n_bytes) {
    refuse_deep_calls();
    return allocate_block(current_pe(), n_bytes);
  }
  static void operator delete(void* frame, std::size_t n_bytes) { release_block(frame, n_bytes); }

  TaskAccount account;
  TaskHandle parent;
  std::exception_ptr error;
  bool detached = false;

  TaskPromise();
  /// A member function of an element: the coroutine is that element's, also if other code calls it
  /// as an object. (The class of a lambda is not complete yet, and g++ 12 deduces a reference.)
  template <class Object, class... Arguments>
    requires std::convertible_to<std::remove_reference_t<Object>*, const TessElement*>
  explicit TaskPromise(Object& object, Arguments&... /*unused*/) : TaskPromise() {
    if (account.context.element != &object) account.belongs_to(object);
  }
  std::suspend_never initial_suspend() noexcept { return {}; }
  struct Final {
    bool await_ready() noexcept { return false; }
    void await_suspend(TaskHandle self) noexcept;
    void await_resume() noexcept {}
  };
  Final final_suspend() noexcept { return {}; }
  void unhandled_exception() { error = std::current_exception(); }
};

/// What tasks of all types have: it holds the coroutine.
class AnyTask {
 public:
  AnyTask(AnyTask&& other) noexcept : handle_(std::exchange(other.handle_, {})) {}
  AnyTask(const AnyTask&) = delete;
  AnyTask& operator=(const AnyTask&) = delete;
  AnyTask& operator=(AnyTask&&) = delete;
  /// A waiting task continues by itself, for its element. (The destructor does not throw: g++ 12
  /// fails on a coroutine whose result type throws.)
  ~AnyTask();

  // A task may await another: the parent continues, through the queue, when the child is done.
  [[nodiscard]] bool await_ready() const noexcept { return handle_.done(); }
  void await_suspend(TaskHandle parent);

 protected:
  explicit AnyTask(TaskHandle handle) : handle_(handle) {}
  /// Throws what the coroutine threw.
  void rethrow() {
    if (handle_.promise().error)
      std::rethrow_exception(std::exchange(handle_.promise().error, nullptr));
  }
  [[nodiscard]] void* frame() const { return handle_.address(); }

 private:
  TaskHandle handle_;
};

/// Ends the job: the value of a task was taken before.
[[noreturn]] void refuse_second_await();

}  // namespace detail

class [[nodiscard]] Task : public detail::AnyTask {
 public:
  struct promise_type : detail::TaskPromise {
    using TaskPromise::TaskPromise;
    Task get_return_object() {
      return Task(std::coroutine_handle<promise_type>::from_promise(*this));
    }
    void return_void() noexcept {}
  };
  using Handle = detail::TaskHandle;

  void await_resume() { rethrow(); }

 private:
  explicit Task(detail::TaskHandle handle) : AnyTask(handle) {}
};

/// A task that gives a value:
///
/// Sample: tests/samples/task_of.cpp
///
///     tess::TaskOf<double> mean_level(tess::ArrayProxy<Lake> lakes) {
///       const double of_all = co_await lakes.reduce<&Lake::level>();
///       co_return of_all / static_cast<double>(lakes.size());
///     }
///       // …
///       const double mean = co_await mean_level(lakes);
///
/// T can be moved; it needs neither a copy nor a default constructor. The first co_await takes the
/// value; a second one ends the job. An exception passes as with Task. The coroutine runs when it
/// is called, so several may be under way at once: call them, then await one after the other, or a
/// vector of them with when_all() (when.hpp). The value of a task that is not awaited is dropped.
///
/// An entry method that is asked may return TaskOf (ask.hpp). One that is sent to may not, and
/// neither may the function passed to run(), since nothing takes their values.
template <class T>
class [[nodiscard]] TaskOf : public detail::AnyTask {
  static_assert(std::is_object_v<T> && std::is_same_v<T, std::remove_cv_t<T>>,
                "a task gives a value: TaskOf<T> of a T that is no reference and not const");

 public:
  struct promise_type : detail::TaskPromise {
    static_assert(alignof(T) <= 2 * sizeof(void*),
                  "frames of coroutines are aligned to 16 bytes: let the task give a "
                  "std::unique_ptr<T>");
    std::optional<T> value;  // until it is taken

    using TaskPromise::TaskPromise;
    TaskOf get_return_object() {
      return TaskOf(std::coroutine_handle<promise_type>::from_promise(*this));
    }
    void return_value(T result) { value.emplace(std::move(result)); }
  };

  T await_resume() {
    rethrow();
    std::optional<T>& value =
        std::coroutine_handle<promise_type>::from_address(frame()).promise().value;
    if (!value) detail::refuse_second_await();
    T result = std::move(*value);
    value.reset();
    return result;
  }

 private:
  explicit TaskOf(detail::TaskHandle handle) : AnyTask(handle) {}
};

/// An awaitable calls it to suspend a coroutine and to record what it waits for, and resumes it
/// through resume_later().
void suspend(Task::Handle task, std::function<detail::WaitReason()> waits_for);

namespace detail {
/// Does the same for an awaitable with waits_for(), which stays where it is.
void suspend_at(Task::Handle task, void* awaitable, WaitReason (*waits_for)(void*));
template <class Awaitable>
void suspend_on(Task::Handle task, Awaitable& awaitable) {
  suspend_at(task, &awaitable,
             [](void* of) -> WaitReason { return static_cast<Awaitable*>(of)->waits_for(); });
}

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
  /// Does the same at the end of a message of the runtime, without a message of its own.
  void wake_at_end();

 private:
  Task::Handle task_;
  std::ptrdiff_t n_left_ = 0;
};
}  // namespace detail

/// Puts a suspended coroutine into the queue of its PE; must be called on that PE.
void resume_later(Task::Handle task);

}  // namespace tess
