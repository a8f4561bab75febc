// A question that the main coroutine asks all PEs:
//
//     AskAll<&save_here> saved(question);       // Answer save_here(Pe&, const Question&)
//     const auto answers = co_await saved;      // one answer per PE, in their order
//
// It is used on PE 0. Questions and answers are counted in epoch 0.
#pragma once

#include "runtime/scheduler/pe_action.hpp"
#include "runtime/task.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tess::detail {

template <class F>
struct AllHandler;
template <class A, class Q>
struct AllHandler<A (*)(Pe&, const Q&)> {
  using Answer = A;
  using Question = Q;
};

template <auto Handler>
class AskAll {
 public:
  using Answer = typename AllHandler<decltype(Handler)>::Answer;
  using Question = typename AllHandler<decltype(Handler)>::Question;

  explicit AskAll(Question question) : question_(std::move(question)) {}
  AskAll(const AskAll&) = delete;
  AskAll& operator=(const AskAll&) = delete;
  ~AskAll() {
    if (id_ != 0) pe_.leave_future(id_);
  }

  [[nodiscard]] bool await_ready() const noexcept { return false; }
  void await_suspend(Task::Handle task) {
    task_ = task;
    id_ = pe_.enter_future(this);
    n_left_ = static_cast<std::size_t>(pe_.n_pes());
    answers_.resize(n_left_);
    suspend(task, [] { return std::string("the answers of all PEs about a checkpoint"); });
    for (std::int32_t to = 0; to < pe_.n_pes(); ++to)
      send_system<&AskAll::asked>(pe_, PeId{to}, Asked{id_, pe_.id(), question_});
  }
  std::vector<Answer> await_resume() { return std::move(answers_); }

 private:
  struct Asked {
    std::uint64_t id = 0;
    PeId from;
    Question question;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(id, from, question);
    }
  };
  struct Answered {
    std::uint64_t id = 0;
    PeId from;
    Answer answer;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(id, from, answer);
    }
  };
  static void asked(Pe& pe, Asked&& m) {
    send_system<&AskAll::answered>(pe, m.from, Answered{m.id, pe.id(), Handler(pe, m.question)});
  }
  static void answered(Pe& pe, Answered&& m) {
    auto* const all = static_cast<AskAll*>(pe.find_future(m.id));
    if (all == nullptr) return;  // the run ends, and the coroutine was freed
    all->answers_[static_cast<std::size_t>(m.from.value)] = std::move(m.answer);
    if (--all->n_left_ == 0) resume_later(all->task_);
  }

  Pe& pe_ = current_pe();
  const Question question_;
  std::uint64_t id_ = 0;
  Task::Handle task_;
  std::size_t n_left_ = 0;
  std::vector<Answer> answers_;
};

}  // namespace tess::detail
