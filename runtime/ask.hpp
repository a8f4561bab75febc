// Awaited replies: the value that a member function of an element returns, on any PE.
//
// Sample: tests/samples/ask.cpp
//
//     const double depth = co_await wells[{5}].ask<&Well::depth>();
//     // …
//     co_await wells[{2}].ask<&Well::slow>().within(5us);
//
// The function returns a value or nothing, or is a coroutine (tess::Task, tess::TaskOf<T>), whose
// end is awaited. An Error that it throws, and one that says that no reply came within the limit,
// are thrown here.
//
// An ask is a message with the number of a place on the asking PE; the reply is a message to that
// place. The call is sent when ask() is called, so several may be under way at once: see when.hpp.
// An Ask that is destroyed before its reply is there is cancelled: the function still runs, and its
// reply is dropped and counted (statistics().late_replies). The call itself is not withdrawn: if
// the element never comes to exist, the end of the run reports the message that waits for it.
#pragma once

#include "runtime/arrays/typed/call.hpp"
#include "runtime/callback.hpp"
#include "runtime/core/duration.hpp"
#include "runtime/core/error.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/task.hpp"

#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace tess {

namespace detail {

/// Where a reply goes.
struct ReplyPlace {
  std::uint64_t id = 0;
  PeId pe{};
};

/// An error as a reply carries it.
struct Failure {
  ErrorCode code{};
  std::string message;
};

/// The part of an ask that does not depend on the type of the reply. It stays on its PE.
class AskBase {
 public:
  AskBase() : pe_(&current_pe()), id_(pe_->futures().enter(this)) {}
  AskBase(const AskBase&) = delete;
  AskBase& operator=(const AskBase&) = delete;
  AskBase& operator=(AskBase&&) = delete;
  virtual ~AskBase() { leave(); }

  [[nodiscard]] ReplyPlace place() const { return {id_, pe_->id()}; }
  /// No reply is wanted any more.
  void cancel() { leave(); }

  void await_suspend(Task::Handle task);

  // when_all and when_any call these.
  void wait(Waiter& waiter);
  void withdraw() { waiting_ = nullptr; }
  [[nodiscard]] bool failed() const { return failure_.has_value(); }
  /// "the reply of Cell[5].f"
  [[nodiscard]] virtual WaitReason waits_for() const = 0;

  /// Takes the reply's place; null, and counted, if its asker waits no longer.
  [[nodiscard]] static AskBase* take(Pe& pe, std::uint64_t id);

 protected:
  /// It may move on its own PE only, and not while a coroutine waits for it.
  AskBase(AskBase&& other) noexcept;

  void set_deadline(Time limit);
  [[nodiscard]] static WaitReason reply_of(CollectionId of, std::uint64_t hash, std::string name);
  /// The reply is there. Returns the waiter that is to be woken, or null.
  [[nodiscard]] Waiter* done() {
    leave();
    return std::exchange(waiting_, nullptr);
  }
  std::optional<Failure> failure_;

 private:
  void require_here() const;
  void leave();
  void expire();

  Pe* pe_;
  std::uint64_t id_ = 0;  // 0: no reply is expected
  std::uint64_t timer_ = 0;
  Time limit_{0};
  Waiter own_;
  Waiter* waiting_ = nullptr;
};

template <class Value>
class AskOf : public AskBase {
 public:
  struct Reply {
    std::uint64_t id = 0;
    std::optional<Value> value;
    std::optional<Failure> failure;
    using GivesMembers = void;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(id, value, failure);
    }
  };

  /// Replies, in the epoch of the call.
  static void answer(Pe& here, EpochId epoch, const ReplyPlace& to, std::optional<Value>&& value,
                     std::optional<Failure>&& failure) {
    here.send(to.pe, make_message_in<&AskOf::arrives>(
                         here, epoch, Reply{to.id, std::move(value), std::move(failure)}));
  }

  [[nodiscard]] bool await_ready() const { return value_.has_value() || failure_.has_value(); }

 protected:
  std::optional<Value> value_;
  bool taken_ = false;  // a co_await has moved the value out

 private:
  static void arrives(Pe& pe, Reply&& reply, Counted /*counted*/) {
    Waiter* waiter = nullptr;
    if (auto* ask = static_cast<AskOf*>(AskBase::take(pe, reply.id)); ask != nullptr) {
      ask->value_ = std::move(reply.value);
      ask->failure_ = std::move(reply.failure);
      waiter = ask->done();
    }
    if (waiter != nullptr) waiter->wake_at_end();
  }
};

/// The value that member function F replies; NoValue for none.
template <auto F>
using ReplyValue = ValueOrNone<typename GivenBy<typename EntryTraits<F>::Result>::type>;

/// A call of member function F of an element of C that replies.
template <class C, class Head, auto F>
struct AskCall final : TypedMessage<AskCall<C, Head, F>, C, ArgumentsBehind<F, Head, ReplyPlace>> {
  using Base = TypedMessage<AskCall, C, ArgumentsBehind<F, Head, ReplyPlace>>;
  using Index = typename C::Index;
  using Value = ReplyValue<F>;
  using Result = typename EntryTraits<F>::Result;
  using Base::Base;

  static void invoke(Element& element, ElementMessage<Index>& envelope) {
    auto& message = static_cast<AskCall&>(envelope);
    std::apply(
        [&](const Head& head, const ReplyPlace& to, auto&... argument) {
          auto& chare = called<C>(head, element);
          if constexpr (GivenBy<Result>::is_task) {
            (void)serve(&chare, to, std::move(argument)...);
          } else {
            std::optional<Value> value;
            std::optional<Failure> failure;
            try {
              if constexpr (std::is_void_v<Result>) {
                (chare.*F)(std::move(argument)...);
                value.emplace();
              } else {
                value.emplace((chare.*F)(std::move(argument)...));
              }
            } catch (const Error& error) {
              failure = Failure{error.code(), error.what()};
            }
            reply(to, message.epoch, std::move(value), std::move(failure));
          }
        },
        message.arguments);
  }
  /// The element was destroyed, or its array was.
  static void undelivered(Pe& pe, ElementMessage<Index>& envelope) {
    auto& message = static_cast<AskCall&>(envelope);
    AskOf<Value>::answer(
        pe, message.epoch, std::get<1>(message.arguments), std::nullopt,
        Failure{ErrorCode::out_of_range, text(name(message.index),
                                              " is asked, but the element was destroyed: ask only "
                                              "elements that exist, or catch this error")});
  }
  [[nodiscard]] static std::string name(const Index& index) {
    const std::string method = plain_name(naming::value<F>());
    const auto colons = method.rfind("::");
    return text(plain_name(name_of_type<C>), index_text(index), ".",
                colons == std::string::npos ? method : method.substr(colons + 2));
  }
  static std::int64_t priority_of(const Envelope& envelope)
    requires MayHavePriority<C, Head, F>
  {
    return priority_by<C, F>(std::get<0>(static_cast<const AskCall&>(envelope).arguments));
  }
  static inline const ElementAction<Index> entry{std::type_identity<AskCall>{}, &AskCall::invoke,
                                                 nullptr, Traffic::user, &AskCall::undelivered};

 private:
  static void reply(const ReplyPlace& to, EpochId epoch, std::optional<Value>&& value,
                    std::optional<Failure>&& failure) {
    AskOf<Value>::answer(current_pe(), epoch, to, std::move(value), std::move(failure));
  }
  /// Runs a coroutine of the element, and replies once it is done.
  template <class Called, class... P>
  static Task serve(Called* chare, ReplyPlace to, P... argument) {
    const EpochId epoch = current_pe().context().epoch;
    std::optional<Value> value;
    std::optional<Failure> failure;
    try {
      Result work = (chare->*F)(std::move(argument)...);
      if constexpr (std::is_same_v<Result, Task>) {
        co_await work;
        value.emplace();
      } else {
        Value given = co_await work;
        value.emplace(std::move(given));
      }
    } catch (const Error& error) {
      failure = Failure{error.code(), error.what()};
    }
    reply(to, epoch, std::move(value), std::move(failure));
  }
};

}  // namespace detail

/// An awaited reply of member function F of an element of C; made by ElementProxy::ask().
template <class C, auto F>
class [[nodiscard]] Ask final : public detail::AskOf<detail::ReplyValue<F>> {
  using Value = detail::ReplyValue<F>;

 public:
  using Index = typename C::Index;

  Ask(CollectionId collection, const Index& index) : collection_(collection), index_(index) {}

  /// If no reply has come after this time from now, the asker gets an Error that names the element,
  /// the function and the time. A reply that comes later is dropped and counted; but where the PE
  /// is busy beyond the limit, one that runs before the timer is taken.
  [[nodiscard]] Ask within(std::chrono::nanoseconds limit) && {
    this->set_deadline(limit);
    return std::move(*this);
  }

  auto await_resume() {
    if (this->failure_) throw Error(this->failure_->code, this->failure_->message);
    if constexpr (!std::is_same_v<Value, NoValue>) {
      TESS_CHECK(!std::exchange(this->taken_, true), waits_for().text,
                 " is awaited again: the first co_await took it, so keep that");
      return std::move(*this->value_);
    }
  }
  [[nodiscard]] detail::WaitReason waits_for() const override {
    return this->reply_of(collection_, IndexHash<Index>()(index_),
                          detail::AskCall<C, detail::OfEntry, F>::name(index_));
  }

 private:
  CollectionId collection_;
  Index index_;
};

}  // namespace tess
