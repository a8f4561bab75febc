// A question that the main coroutine asks all PEs:
//
//     AskAll<&save_here> saved(question);       // Answer save_here(Pe&, const Question&)
//     const auto answers = co_await saved;      // one answer per PE, in their order
//
// AskAll<&first, &then> passes each question on: first() returns Onward{PE, Middle}, and on that PE
// then(Pe&, const Middle&) returns the answer. With a list of PEs only these are asked, and the
// answers of the others are empty.
//
// It is used on PE 0. Questions and answers are counted in epoch 0.
#pragma once

#include "runtime/pe/pe_action.hpp"
#include "runtime/task.hpp"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <type_traits>
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

template <class Middle>
struct Onward {
  PeId to;
  Middle middle;
};

/// For a handler: what is wrong with what it does; empty if nothing is.
template <class Does>
[[nodiscard]] std::string error_of(const Does& does) {
  try {
    does();
  } catch (const std::exception& error) {  // also of serialize(), which is the user's
    current_pe().error().forget_place();
    return error.what();
  } catch (...) {
    current_pe().error().forget_place();
    return "an exception that is not a std::exception";
  }
  return {};
}

template <auto Handler, auto Then = nullptr>
class AskAll {
  static constexpr bool is_direct = std::is_same_v<decltype(Then), std::nullptr_t>;
  using Last = std::conditional_t<is_direct, decltype(Handler), decltype(Then)>;

 public:
  using Answer = typename AllHandler<Last>::Answer;
  using Question = typename AllHandler<decltype(Handler)>::Question;

  explicit AskAll(Question question) : question_(std::move(question)) {
    for (std::int32_t pe = 0; pe < pe_.n_pes(); ++pe) asked_.push_back(PeId{pe});
  }
  /// At least one PE.
  AskAll(Question question, std::vector<PeId> pes)
      : question_(std::move(question)), asked_(std::move(pes)) {}
  AskAll(const AskAll&) = delete;
  AskAll& operator=(const AskAll&) = delete;
  ~AskAll() {
    if (id_ != 0) pe_.futures().leave(id_);
  }

  [[nodiscard]] bool await_ready() const noexcept { return false; }
  void await_suspend(Task::Handle task) {
    task_ = task;
    id_ = pe_.futures().enter(this);
    n_left_ = asked_.size();
    answers_.resize(static_cast<std::size_t>(pe_.n_pes()));
    suspend(task, [] { return std::string("the answers of all PEs about a checkpoint"); });
    for (const PeId to : asked_)
      send_system<&AskAll::asked>(pe_, to, Asked{id_, pe_.id(), question_});
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
  template <class Middle>
  struct Passed {
    std::uint64_t id = 0;
    PeId from, asked;
    Middle middle;
    using GivesMembers = void;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(id, from, asked, middle);
    }
  };
  static void asked(Pe& pe, Asked&& m) {
    if constexpr (is_direct) {
      send_system<&AskAll::answered>(pe, m.from, Answered{m.id, pe.id(), Handler(pe, m.question)});
    } else {
      auto onward = Handler(pe, m.question);
      using Middle = decltype(onward.middle);
      send_system<&AskAll::template passed<Middle>>(
          pe, onward.to, Passed<Middle>{m.id, m.from, pe.id(), std::move(onward.middle)});
    }
  }
  template <class Middle>
  static void passed(Pe& pe, Passed<Middle>&& m) {
    send_system<&AskAll::answered>(pe, m.from, Answered{m.id, m.asked, Then(pe, m.middle)});
  }
  static void answered(Pe& pe, Answered&& m) {
    auto* const all = static_cast<AskAll*>(pe.futures().find(m.id));
    if (all == nullptr) return;  // the run ends, and the coroutine was freed
    all->answers_[static_cast<std::size_t>(m.from.value)] = std::move(m.answer);
    if (--all->n_left_ == 0) resume_later(all->task_);
  }

  Pe& pe_ = current_pe();
  const Question question_;
  std::vector<PeId> asked_;
  std::uint64_t id_ = 0;
  Task::Handle task_;
  std::size_t n_left_ = 0;
  std::vector<Answer> answers_;
};

}  // namespace tess::detail
