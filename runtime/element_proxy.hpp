// The proxy of one element: a small value that can be stored, sent, and used on every PE. It sends
// messages to the element, asks it, creates, moves and destroys it. The element need not exist, and
// may be anywhere: the part of the array on this PE (detail::Array) finds it. Programs include
// runtime/array.hpp.
#pragma once

#include "runtime/arrays/typed/typed_array.hpp"
#include "runtime/ask.hpp"
#include "runtime/epoch.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/sends.hpp"

#include <tuple>
#include <type_traits>
#include <utility>

namespace tess {

template <class C>
class ArrayProxy;

/// The proxy of one element, by its index. The element need not exist. A class that has a proxy of
/// its own elements as a member names the index: ElementProxy<Node, Index1>.
template <class C, class IndexType = typename C::Index>
class ElementProxy : public Sends<ElementProxy<C, IndexType>> {
 public:
  using Index = IndexType;
  using Receiver = C;
  template <class Self>
  using Verbs = Sends<Self>;

  /// It refers to no element: it can only be assigned to.
  ElementProxy() = default;
  ElementProxy(CollectionId collection, const Index& index)
      : collection_(collection), index_(index) {}

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
  /// all elements contribute by contribute(RoundId, …). What contributes to the round is called
  /// after this call, or as its consequence.
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

  /// Destroys the element once none of its code runs or waits. `co_await element.destroy()` waits
  /// until it is gone; if a coroutine of it waits, only until the element knows that it is to end,
  /// since that coroutine may await the same epoch.
  auto destroy() const {
    static_assert(check_no_member());
    return detail::Deed([to = *this] { to.template system<detail::Destruction<C>>(); });
  }
  /// Moves the element to a PE.
  void migrate_to(PeId pe) const {
    static_assert(check_no_member());
    detail::check_exists(current_pe(), pe);
    system<detail::Relocation<C>>(pe);
  }

  [[nodiscard]] ArrayProxy<C> array() const { return ArrayProxy<C>(collection_); }
  [[nodiscard]] const Index& index() const { return index_; }
  /// The PE to which a message for the element is sent from this PE: this one while the array is
  /// not known here, since messages wait for it.
  [[nodiscard]] PeId next_pe() const {
    Pe& pe = current_pe();
    if constexpr (detail::OnePerPe<C>) return PeId{index_.x};
    detail::Collection* collection = detail::find_collection(pe, collection_);
    if (collection != nullptr) return static_cast<detail::Array<C>*>(collection)->next_pe(index_);
    check_not_empty();
    return pe.id();
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
               name_of_type<C>, ">: assign array[index], or what create() gives, to it first");
  }
  static consteval bool check_no_member() {
    static_assert(!detail::OnePerPe<C>,
                  "a member of a group is created, moved and destroyed with its group");
    return true;
  }

  friend detail::ProxyAccess;

  void check_receiver() const {
    if constexpr (detail::OnePerPe<C>) detail::check_exists(current_pe(), PeId{index_.x});
  }
  template <auto F, class Of, class... Args>
  void post(detail::How<Of> how, Args&&... args) const {
    static_assert(detail::check_entry<C, F, Args...>());
    if constexpr (detail::entry_rule<C, F>.inlined)
      if (how.may_run_now && how.demand == detail::Demand::none &&
          run_now<F>(std::forward<Args>(args)...))
        return;
    Pe& pe = current_pe();
    demand_and_post<F>(
        pe, how,
        detail::Call<C, Of, F>::make(pe, collection_, index_, how.of, std::forward<Args>(args)...));
  }
  template <auto F, class Of, class... Args>
  [[nodiscard]] Ask<C, F> ask_as(detail::How<Of> how, Args&&... args) const {
    static_assert(detail::check_ask<C, F, Args...>());
    Pe& pe = current_pe();
    Ask<C, F> reply(collection_, index_);
    demand_and_post<F>(pe, how,
                       detail::AskCall<C, Of, F>::make(pe, collection_, index_, how.of,
                                                       reply.place(), std::forward<Args>(args)...));
    return reply;
  }
  template <auto F, class Of, class Message>
  void demand_and_post(Pe& pe, detail::How<Of> how, Message* message) const {
    using detail::Demand;
    constexpr Demand by_entry = detail::entry_rule<C, F>.demand;
    if constexpr (by_entry != Demand::none) {
      static_assert(check_on_demand());
      if (how.demand == Demand::none) how.demand = by_entry;
    }
    message->demand = how.demand;
    message->ask = how.demand == Demand::here;
    weigh(pe, message->arguments);
    post_message(pe, message);
  }
  static consteval bool check_on_demand() {
    static_assert(!detail::OnePerPe<C>, "a group has all its members: none is created on demand");
    static_assert(std::is_default_constructible_v<C>,
                  "a chare that is created on demand needs a default constructor");
    return true;
  }
  template <class Arguments>
  void weigh(Pe& pe, const Arguments& arguments) const {
    if constexpr (!detail::OnePerPe<C>)  // a balancer does not move members of groups
      detail::weigh(pe, collection_, index_, arguments);
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
    check_receiver();
    detail::post_new(pe, message, [this] { check_not_empty(); });
  }
  template <class... Args>
  void construct(PeId where, detail::Demand demand, std::uint32_t joins, Args&&... args) const {
    static_assert(check_no_member());
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

  [[nodiscard]] std::tuple<CollectionId, Index> fields() const { return {collection_, index_}; }
  [[nodiscard]] std::string in_words() const {
    return text(plain_name(name_of_type<C>), index_text(index_));
  }

  CollectionId collection_{};
  Index index_{};
};

}  // namespace tess
