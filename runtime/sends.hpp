// What one can send to, can be sent to in every way. All proxies stand on two sets of verbs:
//
//     Sends        send, send_after, ask, target, with      an element, a member, a single chare, an
//                                                           interface, the object of a process
//     Broadcasts   broadcast, reduce, target, with          an array, a group, a section, a process
//                                                           group, an array's interface
//
// with() gives the same proxy for messages that go in another way: with a priority, or creating
// their element.
//
// Sample: tests/samples/priority.cpp
//
//     searcher.with(tess::Priority{depth}).send<&Searcher::search>(state);  // the shallowest first
//     // …
//     if (ends) searcher.with(tess::expedited).send<&Searcher::stop>();  // before all others
//
// A priority orders the messages that are ready on one PE. It travels with the message to other
// processes and to the PE to which the element has moved. It neither interrupts a running entry
// method nor orders messages that are under way. The broadcasts of an array keep their order among
// themselves: one of a late priority delays those that follow. A coroutine that continues after a
// co_await has no priority, and neither has a reply.
#pragma once

#include "runtime/arrays/elements/element_message.hpp"
#include "runtime/ask.hpp"
#include "runtime/core/handle.hpp"
#include "runtime/future.hpp"
#include "runtime/timer.hpp"
#include "runtime/wire/messages/entry_attributes.hpp"

#include <compare>
#include <tuple>
#include <type_traits>
#include <utility>

namespace tess {

template <class To, class Of>
class With;

namespace detail {

/// How a message goes. `Of` is OfEntry where the attributes of the entry method give the priority,
/// and Priority where the sender gave one.
template <class Of>
struct How {
  [[no_unique_address]] Of of{};
  Demand demand = Demand::none;  ///< none: what the attributes of the entry method say
  bool may_run_now = true;       ///< by inline_when_local
  friend bool operator==(const How&, const How&) = default;
};

/// What the verbs use of a proxy `To`:
///   Receiver                                   the class whose member functions are called
///   Verbs<Self>                                Sends<Self> or Broadcasts<Self>
///   post<F>(how, args…), ask_as<F>(how, args…) of a proxy that Sends
///   broadcast_as<F>(of, args…)                 of one that Broadcasts
///   check_on_demand()                          consteval; refuses Demand where it has no meaning
///   check_receiver()                           if there may be no such receiver
///   fields()                                   a tuple of what serialize() writes
///   in_words()                                 for reports
struct ProxyAccess {
  template <auto F, class To, class Of, class... Args>
  static void post(const To& to, How<Of> how, Args&&... args) {
    to.template post<F>(how, std::forward<Args>(args)...);
  }
  template <auto F, class To, class Of, class... Args>
  static auto ask(const To& to, How<Of> how, Args&&... args) {
    return to.template ask_as<F>(how, std::forward<Args>(args)...);
  }
  template <auto F, class To, class Of, class... Args>
  static void broadcast(const To& to, Of of, Args&&... args) {
    to.template broadcast_as<F>(of, std::forward<Args>(args)...);
  }
  template <auto F, class To, class... Value>
  static void give(const To& to, Value&&... value) {
    to.template give<F>(std::forward<Value>(value)...);
  }
  /// Ends the job if there is no such receiver, before anything is sent or a timer is set.
  template <class To>
  static void check_receiver(const To& to) {
    if constexpr (requires { to.check_receiver(); }) to.check_receiver();
  }
  template <class To>
  static consteval bool check_on_demand() {
    return To::check_on_demand();
  }
  template <class To>
  static auto how(const To& to) {
    return to.how();
  }
  template <class To>
  static auto fields(const To& to) {
    return to.fields();
  }
  template <class To>
  static std::string in_words(const To& to) {
    return to.in_words();
  }
};

/// A target for results: entry method F of what a proxy stands for.
template <class Proxy, auto F>
struct TargetOf {
  using T = typename decltype(target_value<F, NoValue>())::type;

  [[nodiscard]] static auto make(const Proxy& proxy) {
    return std::apply(
        []<class... Fields>(const Fields&... fields) {
          if constexpr ((Bitwise<Fields> && ...)) {
            return make_target<T>(kind, std::in_place, fields...);
          } else {
            return make_target<T>(kind, to_bytes(std::tuple(fields...)));
          }
        },
        ProxyAccess::fields(proxy));
  }

 private:
  static void call(const Callback<T>& callback, T&& value) {
    const auto proxy = from_bytes<Proxy>(callback.where());
    if constexpr (std::is_same_v<T, NoValue>) {
      ProxyAccess::give<F>(proxy);
    } else {
      ProxyAccess::give<F>(proxy, std::move(value));
    }
  }
  static std::string describe(const Callback<T>& callback) {
    return text(plain_name(naming::value<F>()), " of ",
                ProxyAccess::in_words(from_bytes<Proxy>(callback.where())));
  }
  static inline const typename Callback<T>::Kind kind{naming::name_of<TargetOf>(), &call,
                                                      &describe};
};

}  // namespace detail

/// The verbs of a proxy that stands for one receiver.
template <class Self>
class Sends {
 public:
  using IsHandle = void;
  /// Sends a message. If there is no element, the message waits at the home of the index. The entry
  /// method's attributes may change this (EntryAttributes), and so may with().
  template <auto F, class... Args>
  void send(Args&&... args) const {
    detail::ProxyAccess::post<F>(self(), detail::ProxyAccess::how(self()),
                                 std::forward<Args>(args)...);
  }
  /// Sends a message from this PE once the delay is over, unless the timer is cancelled before. The
  /// current epoch and the run wait for it.
  template <auto F, class... Args>
  Timer send_after(std::chrono::nanoseconds delay, Args&&... args) const {
    static_assert(detail::check_entry<typename Self::Receiver, F, Args...>());
    using Arguments = typename detail::EntryTraits<F>::Arguments;
    detail::ProxyAccess::check_receiver(self());
    return after(delay, [to = self(), arguments = detail::as_parameters<Arguments>(
                                          std::forward<Args>(args)...)] {
      std::apply([&to](const auto&... argument) { to.template send<F>(argument...); }, arguments);
    });
  }
  /// Calls member function F of the receiver and returns what `co_await` waits for, an Ask<C, F>:
  /// the value that F returns, or the end of its coroutine. The call is sent at once. A tess::Error
  /// that F throws is thrown in the asker, and so is one if the element was destroyed. If there is
  /// no element yet, the call waits at the home of the index. The entry method's attributes may
  /// change this and give the call a priority (EntryAttributes).
  template <auto F, class... Args>
  [[nodiscard]] auto ask(Args&&... args) const {
    return detail::ProxyAccess::ask<F>(self(), detail::ProxyAccess::how(self()),
                                       std::forward<Args>(args)...);
  }
  /// Sends a message. If there is no element, it is created on this PE; of several PEs that demand
  /// it at once exactly one creates it.
  template <auto F, class... Args>
  void send_or_create_here(Args&&... args) const {
    self().with(create_here).template send<F>(std::forward<Args>(args)...);
  }
  /// Sends a message. If there is no element, it is created on the home PE of the index.
  template <auto F, class... Args>
  void send_or_create_home(Args&&... args) const {
    self().with(create_home).template send<F>(std::forward<Args>(args)...);
  }

  /// Gives the same receiver for messages with a priority, or for messages that create their element.
  [[nodiscard]] With<Self, Priority> with(Priority priority) const { return {self(), {priority}}; }
  [[nodiscard]] With<Self, detail::OfEntry> with(detail::CreatesWhere auto where) const {
    return {self(), {{}, where.demand}};
  }
  /// A target for results: entry method F of the receiver.
  template <auto F>
  [[nodiscard]] auto target() const {
    return detail::TargetOf<Self, F>::make(self());
  }

  friend auto operator<=>(const Sends&, const Sends&) = default;

 private:
  friend detail::ProxyAccess;
  [[nodiscard]] const Self& self() const { return static_cast<const Self&>(*this); }
  [[nodiscard]] static detail::How<detail::OfEntry> how() { return {}; }
  template <auto F, class... Value>
  void give(Value&&... value) const {
    auto as = detail::ProxyAccess::how(self());
    as.may_run_now = false;
    detail::ProxyAccess::post<F>(self(), as, std::forward<Value>(value)...);
  }
};

/// The verbs of a proxy that stands for many receivers.
template <class Self>
class Broadcasts {
 public:
  using IsHandle = void;
  /// Calls entry method F of each: of an array, of every element that exists when the broadcast
  /// reaches its PE; of a group, of every member.
  template <auto F, class... Args>
  void broadcast(Args&&... args) const {
    detail::ProxyAccess::broadcast<F>(self(), detail::ProxyAccess::how(self()).of,
                                      std::forward<Args>(args)...);
  }
  /// Broadcasts to entry method F, whose last parameter is a Callback<T>, with a new future's
  /// callback behind these arguments. Returns that Future<T>: `co_await all.reduce<&C::f>(args…)`
  /// gives the result. The target takes one value; usually each element contributes to it, in F or
  /// later. The future has the rules of every Future: it belongs to this PE and has to outlive the
  /// result, so if it is dropped before, the arrival of the result ends the job. If an array that
  /// is to contribute ends first, no result comes, and the report of the deadlock says what waits.
  template <auto F, class... Args>
  [[nodiscard]] detail::FutureOf<F> reduce(Args&&... args) const {
    detail::FutureOf<F> result;
    broadcast<F>(std::forward<Args>(args)..., result.callback());
    return result;
  }
  /// Gives the same receivers for broadcasts with a priority.
  [[nodiscard]] With<Self, Priority> with(Priority priority) const { return {self(), {priority}}; }
  /// A target for results: entry method F of all.
  template <auto F>
  [[nodiscard]] auto target() const {
    return detail::TargetOf<Self, F>::make(self());
  }

  friend auto operator<=>(const Broadcasts&, const Broadcasts&) = default;

 private:
  friend detail::ProxyAccess;
  [[nodiscard]] const Self& self() const { return static_cast<const Self&>(*this); }
  [[nodiscard]] static detail::How<detail::OfEntry> how() { return {}; }
  template <auto F, class... Value>
  void give(Value&&... value) const {
    broadcast<F>(std::forward<Value>(value)...);
  }
};

/// A proxy, and how its messages go: what proxy.with(…) gives. It is a value as the proxy is.
template <class To, class Of>
class With : public To::template Verbs<With<To, Of>> {
 public:
  using Receiver = typename To::Receiver;

  With() = default;
  With(const To& to, detail::How<Of> how) : to_(to), how_(how) {
    if constexpr (std::is_same_v<Of, detail::OfEntry>)
      static_assert(detail::ProxyAccess::check_on_demand<To>());
  }

  [[nodiscard]] With<To, Priority> with(Priority priority) const {
    return {to_, {priority, how_.demand}};
  }
  [[nodiscard]] With with(detail::CreatesWhere auto where) const {
    static_assert(detail::ProxyAccess::check_on_demand<To>());
    return {to_, {how_.of, where.demand}};
  }

  friend bool operator==(const With&, const With&) = default;
  [[nodiscard]] std::size_t hash() const {
    std::uint64_t how = static_cast<std::uint64_t>(how_.demand) << 56U;
    if constexpr (std::is_same_v<Of, Priority>)
      how ^= mix(static_cast<std::uint64_t>(how_.of.value));
    return static_cast<std::size_t>(mix(to_.hash() ^ how));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(to_, how_.of, how_.demand);
  }

 private:
  friend detail::ProxyAccess;

  [[nodiscard]] detail::How<Of> how() const { return how_; }
  void check_receiver() const { detail::ProxyAccess::check_receiver(to_); }
  template <auto F, class... Args>
  void post(detail::How<Of> how, Args&&... args) const {
    detail::ProxyAccess::post<F>(to_, how, std::forward<Args>(args)...);
  }
  template <auto F, class... Args>
  [[nodiscard]] auto ask_as(detail::How<Of> how, Args&&... args) const {
    return detail::ProxyAccess::ask<F>(to_, how, std::forward<Args>(args)...);
  }
  template <auto F, class... Args>
  void broadcast_as(Of of, Args&&... args) const {
    detail::ProxyAccess::broadcast<F>(to_, of, std::forward<Args>(args)...);
  }
  [[nodiscard]] auto fields() const {
    return std::tuple_cat(detail::ProxyAccess::fields(to_), std::tuple(how_.of, how_.demand));
  }
  [[nodiscard]] std::string in_words() const { return detail::ProxyAccess::in_words(to_); }

  To to_{};
  detail::How<Of> how_{};
};

}  // namespace tess
