// The proxy of one element: a small value that can be stored, sent, and used on every PE. It sends
// messages to the element, asks it, creates, moves and destroys it. The element need not exist, and
// may be anywhere: the part of the array on this PE (detail::Array) finds it. Programs include
// runtime/array.hpp.
#pragma once

#include "runtime/ask.hpp"
#include "runtime/collections/arrays/typed_array.hpp"
#include "runtime/core/handle.hpp"
#include "runtime/priority.hpp"
#include "runtime/scheduler/pe_action.hpp"
#include "runtime/timer.hpp"

#include <tuple>
#include <type_traits>
#include <utility>

namespace tess {

namespace detail {

/// A target for results: entry method F of what a proxy stands for.
template <class Proxy, auto F>
struct TargetOf {
  using T = typename decltype(target_value<F, NoValue>())::type;

  /// The fields are those of the proxy, in the order of its serialize().
  template <class... Fields>
  [[nodiscard]] static auto make(const Fields&... fields) {
    if constexpr ((Bitwise<Fields> && ...)) {
      return make_target<T>(kind, std::in_place, fields...);
    } else {
      return make_target<T>(kind, to_bytes(std::tuple(fields...)));
    }
  }

 private:
  static void call(const Callback<T>& callback, T&& value) {
    const auto proxy = from_bytes<Proxy>(callback.where());
    if constexpr (std::is_same_v<T, NoValue>) {
      proxy.template give<F>();
    } else {
      proxy.template give<F>(std::move(value));
    }
  }
  static std::string describe(const Callback<T>& callback) {
    return text(plain_name(naming::value<F>()), " of ",
                from_bytes<Proxy>(callback.where()).in_words());
  }
  static inline const typename Callback<T>::Kind kind{naming::name_of<TargetOf>(), &call,
                                                      &describe};
};

}  // namespace detail

/// The proxy of one element, by its index. The element need not exist. A class that has a proxy of
/// its own elements as a member names the index: ElementProxy<Node, Index1>.
template <class C, class IndexType = typename C::Index>
class ElementProxy {
 public:
  using Index = IndexType;

  /// Of no element: it can only be assigned to.
  ElementProxy() = default;
  ElementProxy(CollectionId collection, const Index& index)
      : collection_(collection), index_(index) {}

  /// Sends a message. If there is no element, the message waits at the home of the index. The entry
  /// method's attributes may change this (EntryAttributes).
  template <auto F, class... Args>
  void send(Args&&... args) const {
    send_as<F>(detail::OfEntry(), std::forward<Args>(args)...);
  }
  /// Sends a message from this PE once the delay is over, unless the timer is cancelled before. The
  /// current epoch and the run wait for it.
  template <auto F, class... Args>
  Timer send_after(std::chrono::nanoseconds delay, Args&&... args) const {
    static_assert(detail::check_entry<C, F, Args...>());
    using Arguments = typename detail::EntryTraits<F>::Arguments;
    return after(delay, [to = *this, arguments = detail::as_parameters<Arguments>(
                                         std::forward<Args>(args)...)] {
      std::apply([&to](const auto&... argument) { to.template send<F>(argument...); }, arguments);
    });
  }
  /// Calls member function F of the element and returns what `co_await` waits for: the value that F
  /// returns, or the end of its coroutine. The call is sent at once. A tess::Error that F throws is
  /// thrown in the asker, and so is one if the element was destroyed. If there is no element yet,
  /// the call waits at the home of the index. The entry method's attributes may change this and
  /// give the call a priority (EntryAttributes).
  template <auto F, class... Args>
  [[nodiscard]] Ask<C, F> ask(Args&&... args) const {
    return ask_as<F>(detail::OfEntry(), std::forward<Args>(args)...);
  }
  /// Sends a message. If there is no element, it is created on this PE; of several PEs that demand
  /// it at once exactly one creates it.
  template <auto F, class... Args>
  void send_or_create_here(Args&&... args) const {
    send_on_demand<F>(detail::OfEntry(), detail::Demand::here, std::forward<Args>(args)...);
  }
  /// Sends a message. If there is no element, it is created on the home PE of the index.
  template <auto F, class... Args>
  void send_or_create_home(Args&&... args) const {
    send_on_demand<F>(detail::OfEntry(), detail::Demand::home, std::forward<Args>(args)...);
  }
  /// The same element for messages with a priority.
  [[nodiscard]] PrioritisedElement<C, Index> with(Priority priority) const {
    return {*this, priority};
  }

  /// Creates the element on this PE with these constructor arguments; it is misuse if the element
  /// exists. The element receives the broadcasts that reach its PE after its construction, and
  /// joins the reductions that they lead to: see Chare::contribute().
  template <class... Args>
  void insert(Args&&... args) const {
    construct(current_pe().id(), detail::Demand::insert, 0, std::forward<Args>(args)...);
  }
  /// Creates the element on another PE; otherwise like insert().
  template <class... Args>
  void insert_on(PeId pe, Args&&... args) const {
    construct(pe, detail::Demand::insert, 0, std::forward<Args>(args)...);
  }
  /// Creates the element on this PE, or another; its first contribution is to this round, to which
  /// all elements contribute by contribute(RoundId, …). What contributes to the round is called after
  /// this call, or as its consequence.
  template <class... Args>
  void insert(RoundId joins, Args&&... args) const {
    insert_on(current_pe().id(), joins, std::forward<Args>(args)...);
  }
  template <class... Args>
  void insert_on(PeId pe, RoundId joins, Args&&... args) const {
    check_not_empty();
    construct(pe, detail::Demand::insert,
              detail::join_at(current_pe(), collection_, joins, in_words()),
              std::forward<Args>(args)...);
  }
  /// Creates the element on this PE unless it exists.
  template <class... Args>
  void insert_if_absent(Args&&... args) const {
    construct(current_pe().id(), detail::Demand::insert_if_absent, 0, std::forward<Args>(args)...);
  }

  /// Destroys the element.
  void destroy() const { system<detail::Destruction<C>>(); }
  /// Moves the element to a PE.
  void migrate_to(PeId pe) const {
    detail::check_exists(current_pe(), pe);
    system<detail::Relocation<C>>(pe);
  }

  [[nodiscard]] ArrayProxy<C> array() const { return ArrayProxy<C>(collection_); }
  [[nodiscard]] const Index& index() const { return index_; }
  /// The PE to which a message for the element is sent from this PE: this one while the array is
  /// not known here, since messages wait for it.
  [[nodiscard]] PeId next_pe() const {
    Pe& pe = current_pe();
    detail::Collection* collection = detail::find_collection(pe, collection_);
    if (collection != nullptr) return static_cast<detail::Array<C>*>(collection)->next_pe(index_);
    check_not_empty();
    return pe.id();
  }

  /// A target for results: entry method F of this element.
  template <auto F>
  [[nodiscard]] auto target() const {
    return detail::TargetOf<ElementProxy, F>::make(collection_, index_);
  }

  friend auto operator<=>(const ElementProxy&, const ElementProxy&) = default;
  [[nodiscard]] std::size_t hash() const {
    return static_cast<std::size_t>(mix(collection_.value ^ IndexHash<Index>()(index_)));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(collection_, index_);
  }

 private:
  void check_not_empty() const {
    TESS_CHECK(collection_ != CollectionId{}, "a message to an empty ElementProxy<",
               name_of_type<C>, ">: assign array[index] to it first");
  }

  friend class PrioritisedElement<C, Index>;
  template <class, auto>
  friend struct detail::TargetOf;

  // `Of` is OfEntry, or the Priority that the sender gave.

  template <auto F, class Of, class... Args>
  [[nodiscard]] Ask<C, F> ask_as(Of of, Args&&... args) const {
    static_assert(detail::check_ask<C, F, Args...>());
    Pe& pe = current_pe();
    Ask<C, F> reply(collection_, index_);
    auto* message = detail::AskCall<C, Of, F>::make(pe, collection_, index_, of, reply.place(),
                                                    std::forward<Args>(args)...);
    if constexpr (detail::entry_rule<C, F>.creates != detail::Creates::no) {
      static_assert(check_on_demand());
      message->demand = demand_of<F>;
      message->ask = message->demand == detail::Demand::here;
    }
    weigh(pe, message->arguments);
    post_message(pe, message);
    return reply;
  }

  template <auto F, class Of, class... Args>
  void send_as(Of of, Args&&... args) const {
    static_assert(detail::check_entry<C, F, Args...>());
    if constexpr (detail::entry_rule<C, F>.inlined)
      if (run_now<F>(std::forward<Args>(args)...)) return;
    queue<F>(of, std::forward<Args>(args)...);
  }
  /// The same, never inside the caller's entry method.
  template <auto F, class Of, class... Args>
  void queue(Of of, Args&&... args) const {
    constexpr detail::Creates creates = detail::entry_rule<C, F>.creates;
    if constexpr (creates == detail::Creates::no) {
      post<F>(of, detail::Demand::none, std::forward<Args>(args)...);
    } else {
      send_on_demand<F>(of, demand_of<F>, std::forward<Args>(args)...);
    }
  }
  /// For an entry method that creates its element.
  template <auto F>
  static constexpr detail::Demand demand_of =
      detail::entry_rule<C, F>.creates == detail::Creates::here ? detail::Demand::here
                                                                : detail::Demand::home;
  static consteval bool check_on_demand() {
    static_assert(!detail::OnePerPe<C>, "a group has all its members: none is created on demand");
    static_assert(std::is_default_constructible_v<C>,
                  "a chare that is created on demand needs a default constructor");
    return true;
  }
  template <auto F, class Of, class... Args>
  void send_on_demand(Of of, detail::Demand demand, Args&&... args) const {
    static_assert(check_on_demand());
    post<F>(of, demand, std::forward<Args>(args)...);
  }
  template <auto F, class Of, class... Args>
  void post(Of of, detail::Demand demand, Args&&... args) const {
    static_assert(detail::check_entry<C, F, Args...>());
    Pe& pe = current_pe();
    auto* message =
        detail::Call<C, Of, F>::make(pe, collection_, index_, of, std::forward<Args>(args)...);
    message->demand = demand;
    message->ask = demand == detail::Demand::here;
    weigh(pe, message->arguments);
    post_message(pe, message);
  }
  template <class Arguments>
  void weigh(Pe& pe, const Arguments& arguments) const {
    if constexpr (!detail::OnePerPe<C>)  // a balancer does not move members of groups
      if (detail::Meter* meter = pe.meter(); meter != nullptr && meter->weighs_messages())
          [[unlikely]]
        meter->sent({collection_, IndexHash<Index>()(index_)}, detail::payload_bytes(arguments));
  }
  /// Calls the entry method inside the caller's. Returns false, and takes no argument, if it must
  /// be queued.
  template <auto F, class... Args>
  [[nodiscard]] bool run_now(Args&&... args) const {
    Pe& pe = current_pe();
    auto* array = static_cast<detail::Array<C>*>(detail::find_collection(pe, collection_));
    if (array == nullptr) return false;
    auto* element = array->free_to_run(index_);
    if (element == nullptr) return false;
    auto arguments = detail::as_parameters<typename detail::EntryTraits<F>::Arguments>(
        std::forward<Args>(args)...);
    weigh(pe, arguments);
    array->run_now(*element, detail::Call<C, detail::OfEntry, F>::entry, [&] {
      std::apply(
          [element](auto&... argument) {
            (void)(static_cast<C*>(element)->*F)(std::move(argument)...);
          },
          arguments);
    });
    return true;
  }
  void post_message(Pe& pe, detail::ElementMessage<Index>* message) const {
    detail::Counted::departs(pe.completion(), message->epoch);
    if (detail::Collection* collection = detail::find_collection(pe, collection_);
        collection != nullptr) [[likely]] {
      static_cast<detail::Array<C>*>(collection)->post_counted(message);
    } else {
      check_not_empty();
      pe.send_here(message);  // it waits until the array is known here
    }
  }
  template <class... Args>
  void construct(PeId where, detail::Demand demand, std::uint32_t joins, Args&&... args) const {
    static_assert(std::is_constructible_v<C, std::decay_t<Args>...>,
                  "the chare has no constructor that takes these arguments");
    Pe& pe = current_pe();
    detail::check_exists(pe, where);
    auto* message = detail::Construction<C, std::decay_t<Args>...>::make(
        pe, collection_, index_, std::forward<Args>(args)...);
    message->demand = demand;
    message->ask = true;
    message->asker = where;
    message->led_by = joins;
    if (where == pe.id()) {
      post_message(pe, message);
    } else {
      pe.count(*message);
      pe.send(where, message);
    }
  }
  template <class Kind, class... Args>
  void system(Args... args) const {
    Pe& pe = current_pe();
    post_message(pe, Kind::make(pe, collection_, index_, args...));
  }

  template <auto F, class... Value>
  void give(Value&&... value) const {
    queue<F>(detail::OfEntry(), std::forward<Value>(value)...);
  }
  [[nodiscard]] std::string in_words() const {
    return text(plain_name(name_of_type<C>), index_text(index_));
  }

  CollectionId collection_{};
  Index index_{};
};

}  // namespace tess

template <class C, class Index>
struct std::hash<tess::ElementProxy<C, Index>> : tess::detail::HashOfHandle {};
