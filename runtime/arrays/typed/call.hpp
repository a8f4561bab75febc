// The typed messages of an array: calls of entry methods, constructor calls, and broadcasts.
#pragma once

#include "runtime/arrays/elements/make_chare.hpp"
#include "runtime/arrays/typed/array_of.hpp"
#include "runtime/pe/block.hpp"
#include "runtime/wire/messages/entry_attributes.hpp"
#include "runtime/wire/messages/entry_traits.hpp"

#ifdef TESS_CHECKS_ALL
#include "runtime/core/round_trip.hpp"
#endif

namespace tess::detail {

#ifdef TESS_CHECKS_ALL
/// Describes the first argument that differs after a round trip through bytes; empty if all are
/// equal.
template <class... T>
[[nodiscard]] std::string arguments_difference(const std::tuple<T...>& arguments) {
  std::string found;
  const auto look = [&found](const auto& argument) {
    if (found.empty()) found = round_trip_difference(argument);
  };
  std::apply([&look](const auto&... argument) { (look(argument), ...); }, arguments);
  return found;
}
#endif

// What stands before the arguments of a call is its head: OfEntry, the Priority that the sender
// gave, or a Through (interface.hpp).

/// The priority of the call is that which its class gives the entry method.
struct OfEntry {
  friend bool operator==(const OfEntry&, const OfEntry&) = default;
};

/// The priority of a call of F with this head.
template <class C, auto F, class Head>
[[nodiscard]] std::int64_t priority_by(const Head& head) {
  if constexpr (std::is_same_v<Head, OfEntry>) {
    return entry_rule<C, F>.priority;
  } else if constexpr (std::is_same_v<Head, Priority>) {
    return head.value;
  } else {
    return head.priority.value;
  }
}
/// False if no call of F with such a head has a priority.
template <class C, class Head, auto F>
concept MayHavePriority = !std::is_same_v<Head, OfEntry> || entry_rule<C, F>.priority != 0;

/// What a call with this head calls: the element as a C, or by its interface.
template <class C, class Head>
[[nodiscard]] auto& called(const Head& head, Element& element) {
  if constexpr (requires { head.face; }) {
    return head.face->cast(element);
  } else {
    return static_cast<C&>(element);
  }
}

/// The arguments of F behind these values.
template <class Arguments, class... Before>
struct Behind;
template <class... P, class... Before>
struct Behind<std::tuple<P...>, Before...> {
  using Type = std::tuple<Before..., P...>;
};
template <auto F, class... Before>
using ArgumentsBehind = typename Behind<typename EntryTraits<F>::Arguments, Before...>::Type;

/// The packed size of a message's arguments.
template <class... T>
[[nodiscard]] std::uint64_t payload_bytes(const std::tuple<T...>& arguments) {
  if constexpr (((Bitwise<T> || std::is_same_v<T, OfEntry>)&&...)) {
    return ((Bitwise<T> ? sizeof(T) : 0) + ... + 0);
  } else {
    return written_bytes(arguments);
  }
}

/// Tells the balancer, if it asks for it, that such a message is sent.
template <class Index, class Arguments>
void weigh(Pe& pe, CollectionId collection, const Index& index, const Arguments& arguments) {
  if (Meter* meter = pe.meter(); meter != nullptr && meter->weighs_messages()) [[unlikely]]
    meter->sent({collection, IndexHash<Index>()(index)}, payload_bytes(arguments));
}
/// Sends a new message from here, in its epoch. It waits here if its array is not known yet; before,
/// `check` refuses a proxy that names none.
template <class Index, class Check>
void post_new(Pe& pe, ElementMessage<Index>* message, const Check& check) {
  Counted::departs(pe.completion(), message->epoch);
  if (Collection* array = find_collection(pe, message->collection); array != nullptr) [[likely]] {
    static_cast<ArrayOf<Index>*>(array)->post_counted(message);
  } else {
    check();
    pe.send_here(message);
  }
}

/// Construction, packing and release of a message type that derives from ElementMessage and has
/// `arguments`.
template <class Derived, class C, class Arguments>
struct TypedMessage : ElementMessage<typename C::Index> {
  using Index = typename C::Index;
  Arguments arguments;

  TypedMessage() = default;
  template <class... A>
    requires(sizeof...(A) > 0)
  explicit TypedMessage(A&&... a) : arguments(as_parameters<Arguments>(std::forward<A>(a)...)) {}

  template <class... A>
  static Derived* make(Pe& pe, CollectionId collection, const Index& index, A&&... a) {
    auto* message = new (allocate_block(pe, sizeof(Derived))) Derived(std::forward<A>(a)...);
    message->action = &Derived::entry;
    message->collection = collection;
    message->index = index;
    message->asker = pe.id();
    if constexpr (HasPriority<Derived>) message->prioritised = Derived::priority_of(*message) != 0;
    if (pe.context().led_by != 0) message->led_by = Collection::led_by(pe.context(), collection);
#ifdef TESS_CHECKS_ALL
    const std::string difference = arguments_difference(message->arguments);
    TESS_CHECK(difference.empty(), difference);
#endif
    return pe.stamp(message);
  }
  static constexpr Action::Run run = &ArrayOf<Index>::run_message;
  static void destroy(Envelope* envelope) {
    auto* message = static_cast<Derived*>(envelope);
    message->~Derived();
    release_message(envelope);
  }
  static void pack(Envelope& envelope, Writer& ar) {
    auto& message = static_cast<Derived&>(envelope);
    message.serialize_head(ar);
    ar(message.arguments);
  }
  static Envelope* unpack(Pe& pe, Reader& ar) {
    auto* message = new (allocate_received(pe, sizeof(Derived))) Derived();
    message->serialize_head(ar);
    ar(message->arguments);
    return message;
  }
};

/// A call of entry method F of an element of C.
template <class C, class Head, auto F>
struct Call final : TypedMessage<Call<C, Head, F>, C, ArgumentsBehind<F, Head>> {
  using Base = TypedMessage<Call, C, ArgumentsBehind<F, Head>>;
  using Index = typename C::Index;
  using Base::Base;

  static void invoke(Element& element, ElementMessage<Index>& message) {
    std::apply(
        [&element](const Head& head, auto&... argument) {
          (void)(called<C>(head, element).*F)(std::move(argument)...);
        },
        static_cast<Call&>(message).arguments);
  }
  static std::int64_t priority_of(const Envelope& message)
    requires MayHavePriority<C, Head, F>
  {
    return priority_by<C, F>(std::get<0>(static_cast<const Call&>(message).arguments));
  }
  static inline const ElementAction<Index> entry{std::type_identity<Call>{}, &Call::invoke};
};

/// A call of the constructor of C with these argument types.
template <class C, class... Args>
struct Construction final : TypedMessage<Construction<C, Args...>, C, std::tuple<Args...>> {
  using Base = TypedMessage<Construction, C, std::tuple<Args...>>;
  using Index = typename C::Index;
  using Base::Base;

  static Element* construct(ElementMessage<Index>& message) {
    return std::apply([](auto&... argument) { return make_chare<C>(std::move(argument)...); },
                      static_cast<Construction&>(message).arguments);
  }
  static inline const ElementAction<Index> entry{std::type_identity<Construction>{}, nullptr,
                                                 &Construction::construct};
};

/// Destroys an element.
template <class C>
struct Destruction final : TypedMessage<Destruction<C>, C, std::tuple<>> {
  using Base = TypedMessage<Destruction, C, std::tuple<>>;
  using Index = typename C::Index;
  using Base::Base;

  static void invoke(Element& element, ElementMessage<Index>& /*message*/) {
    static_cast<C&>(element).destroy();
  }
  static inline const ElementAction<Index> entry{std::type_identity<Destruction>{},
                                                 &Destruction::invoke};
};

/// Moves an element to a PE.
template <class C>
struct Relocation final : TypedMessage<Relocation<C>, C, std::tuple<PeId>> {
  using Base = TypedMessage<Relocation, C, std::tuple<PeId>>;
  using Index = typename C::Index;
  using Base::Base;

  static void invoke(Element& element, ElementMessage<Index>& message) {
    static_cast<C&>(element).migrate_to(std::get<0>(static_cast<Relocation&>(message).arguments));
  }
  static inline const ElementAction<Index> entry{std::type_identity<Relocation>{},
                                                 &Relocation::invoke};
};

/// Ends an element's wait at its balancer's barrier.
template <class C>
struct Awakening final : TypedMessage<Awakening<C>, C, std::tuple<>> {
  using Base = TypedMessage<Awakening, C, std::tuple<>>;
  using Index = typename C::Index;
  using Base::Base;

  static void invoke(Element& element, ElementMessage<Index>& /*message*/) {
    if (BalancedElements::awake(element)) (void)static_cast<C&>(element).resume_from_sync();
  }
  static inline const ElementAction<Index> entry{std::type_identity<Awakening>{},
                                                 &Awakening::invoke, nullptr, Traffic::control};
};

/// A call of entry method F of all elements.
template <class C, class Head, auto F>
class CallOfAll final : public BroadcastCall {
 public:
  using Arguments = typename EntryTraits<F>::Arguments;

  CallOfAll() = default;
  CallOfAll(const Head& head, Arguments arguments)
      : head_(head), arguments_(std::move(arguments)) {}

  [[nodiscard]] const BroadcastKind& kind() const override { return kind_; }
  [[nodiscard]] std::int64_t priority() const override { return priority_by<C, F>(head_); }
  void invoke(Element& element) const override {
    std::apply([&](const auto&... argument) { (void)(called<C>(head_, element).*F)(argument...); },
               arguments_);
  }
  void pack(Writer& ar) const override { ar(head_, arguments_); }

 private:
  static SharedCall unpack(Reader& ar) {
    auto* const call = new CallOfAll;
    SharedCall made(call);
    ar(call->head_, call->arguments_);
    return made;
  }
  static inline const BroadcastKind kind_{naming::name_of_polymorphic<CallOfAll>(), &unpack};

  [[no_unique_address]] Head head_{};
  Arguments arguments_{};
};

}  // namespace tess::detail
