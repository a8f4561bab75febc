// A result that a coroutine waits for:
//
//     tess::Future<double> total;
//     blocks.broadcast<&Block::add>(total.callback());  // each calls contribute(tess::sum, x, target)
//     const double t = co_await total;
//
// The callback can be sent anywhere; the result arrives at the PE that made the future. It is taken
// once, and the future must outlive it: make it a local variable of the coroutine that awaits it.
#pragma once

#include "runtime/callback.hpp"
#include "runtime/core/check.hpp"
#include "runtime/scheduler/pe_action.hpp"
#include "runtime/task.hpp"

#include <optional>
#include <tuple>

namespace tess {

template <class T>
class Future {
 public:
  Future() : pe_(current_pe()), id_(pe_.enter_future(this)) {}
  Future(const Future&) = delete;
  Future& operator=(const Future&) = delete;
  ~Future() { pe_.leave_future(id_); }

  /// The target that receives the result.
  [[nodiscard]] Callback<T> callback() const {
    return Callback<T>(kind_, to_bytes(std::tuple(pe_.id(), id_)));
  }

  [[nodiscard]] bool await_ready() const { return value_.has_value(); }
  void await_suspend(Task::Handle task) {
    waiting_ = task;
    suspend(task, [] { return text("a future of ", name_of_type<T>); });
  }
  T await_resume() { return std::move(*value_); }

 private:
  struct Result {
    std::uint64_t id = 0;
    T value{};
    using GivesMembers = void;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(id, value);
    }
  };
  static void give(const Callback<T>& callback, T&& value) {
    const auto [pe, id] = from_bytes<std::tuple<PeId, std::uint64_t>>(callback.where());
    Pe& here = current_pe();
    here.completion().sent(here.context().epoch);
    detail::send_system<&Future::arrives>(here, pe, Result{id, std::move(value)});
  }
  static void arrives(Pe& pe, Result&& result) {
    auto* future = static_cast<Future*>(pe.find_future(result.id));
    TESS_CHECK(
        future != nullptr,
        "the result of a future arrived after its coroutine had continued or ended: keep the "
        "future until its result is there");
    TESS_CHECK(!future->value_, "a future was given two results");
    future->value_ = std::move(result.value);
    if (future->waiting_) resume_later(future->waiting_);
    pe.completion().processed(pe.context().epoch);
  }
  static inline const typename Callback<T>::Kind kind_{naming::name_of<&Future::give>(),
                                                       &Future::give};

  Pe& pe_;
  const std::uint64_t id_;
  std::optional<T> value_;
  Task::Handle waiting_;
};

}  // namespace tess
