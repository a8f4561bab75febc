// The typed messages of an array: calls of entry methods, constructor calls, and broadcasts.
#pragma once

#include "runtime/collections/arrays/array_of.hpp"
#include "runtime/collections/elements/make_chare.hpp"
#include "runtime/messages/entry_attributes.hpp"
#include "runtime/messages/entry_traits.hpp"
#include "runtime/scheduler/block.hpp"

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

/// The packed size of a message's arguments.
template <class... T>
[[nodiscard]] std::uint64_t payload_bytes(const std::tuple<T...>& arguments) {
  if constexpr ((Bitwise<T> && ...)) {
    return (sizeof(T) + ... + 0);
  } else {
    return written_bytes(arguments);
  }
}

/// Construction, packing and release of a message type that derives from ElementMessage and has
/// `arguments`.
template <class Derived, class C, class Arguments>
struct TypedMessage : ElementMessage<typename C::Index> {
  using Index = typename C::Index;
  Arguments arguments;

  template <class... A>
  explicit TypedMessage(A&&... a) : arguments(std::forward<A>(a)...) {}

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
    release_block(message, sizeof(Derived));
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
template <class C, auto F>
struct Call final : TypedMessage<Call<C, F>, C, typename EntryTraits<F>::Arguments> {
  using Base = TypedMessage<Call, C, typename EntryTraits<F>::Arguments>;
  using Index = typename C::Index;
  using Base::Base;

  static void invoke(Element& element, ElementMessage<Index>& envelope) {
    auto& message = static_cast<Call&>(envelope);
    std::apply(
        [&element](auto&... argument) {
          (void)(static_cast<C&>(element).*F)(std::move(argument)...);
        },
        message.arguments);
  }
  /// The priority that the class gives to F.
  static std::int64_t priority_of(const Envelope& /*message*/)
    requires(entry_rule<C, F>.priority != 0)
  {
    return entry_rule<C, F>.priority;
  }
  static inline const ElementAction<Index> entry{std::type_identity<Call>{}, &Call::invoke};
};

/// The arguments of a message that carries its own priority.
template <class Arguments>
struct WithPriority;
template <class... P>
struct WithPriority<std::tuple<P...>> {
  using type = std::tuple<std::int64_t, P...>;
};

/// The same call with the priority that the sender gave it.
template <class C, auto F>
struct PrioritisedCall final
    : TypedMessage<PrioritisedCall<C, F>, C,
                   typename WithPriority<typename EntryTraits<F>::Arguments>::type> {
  using Base = TypedMessage<PrioritisedCall, C,
                            typename WithPriority<typename EntryTraits<F>::Arguments>::type>;
  using Index = typename C::Index;
  using Base::Base;

  static void invoke(Element& element, ElementMessage<Index>& envelope) {
    auto& message = static_cast<PrioritisedCall&>(envelope);
    std::apply(
        [&element](std::int64_t /*priority*/, auto&... argument) {
          (void)(static_cast<C&>(element).*F)(std::move(argument)...);
        },
        message.arguments);
  }
  static std::int64_t priority_of(const Envelope& envelope) {
    return std::get<0>(static_cast<const PrioritisedCall&>(envelope).arguments);
  }
  static inline const ElementAction<Index> entry{std::type_identity<PrioritisedCall>{},
                                                 &PrioritisedCall::invoke};
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
    if (Collection::awake(element)) (void)static_cast<C&>(element).resume_from_sync();
  }
  static inline const ElementAction<Index> entry{std::type_identity<Awakening>{},
                                                 &Awakening::invoke, nullptr, Traffic::control};
};

/// A call of entry method F of all elements.
template <class C, auto F>
class CallOfAll : public BroadcastCall {
 public:
  using Arguments = typename EntryTraits<F>::Arguments;

  explicit CallOfAll(Arguments arguments) : arguments_(std::move(arguments)) {}

  [[nodiscard]] const BroadcastKind& kind() const override { return kind_; }
  [[nodiscard]] const Action& action() const override { return action_; }
  [[nodiscard]] std::int64_t priority() const override { return entry_rule<C, F>.priority; }
  void invoke(Element& element) const override {
    std::apply(
        [&element](const auto&... argument) { (void)(static_cast<C&>(element).*F)(argument...); },
        arguments_);
  }
  void pack(Writer& ar) const override { ar(arguments_); }

 private:
  static SharedCall unpack(Reader& ar) { return SharedCall(new CallOfAll(ar.take<Arguments>())); }
  static void never(Pe& /*pe*/, Envelope* /*envelope*/) {}
  static inline const BroadcastKind kind_{naming::name_of<CallOfAll>(), &unpack};
  static inline const Action action_{
      naming::name_of<CallOfAll*>(), nullptr, nullptr, nullptr, nullptr, Traffic::user};

  Arguments arguments_;
};

/// The same with the priority that the sender gave it.
template <class C, auto F>
class PrioritisedCallOfAll final : public CallOfAll<C, F> {
 public:
  using Arguments = typename EntryTraits<F>::Arguments;

  PrioritisedCallOfAll(Priority priority, Arguments arguments)
      : CallOfAll<C, F>(std::move(arguments)), priority_(priority.value) {}

  [[nodiscard]] const BroadcastKind& kind() const override { return kind_; }
  [[nodiscard]] std::int64_t priority() const override { return priority_; }
  void pack(Writer& ar) const override {
    ar(priority_);
    CallOfAll<C, F>::pack(ar);
  }

 private:
  static SharedCall unpack(Reader& ar) {
    const Priority priority{ar.take<std::int64_t>()};
    return SharedCall(new PrioritisedCallOfAll(priority, ar.take<Arguments>()));
  }
  static inline const BroadcastKind kind_{naming::name_of<PrioritisedCallOfAll>(), &unpack};

  std::int64_t priority_;
};

}  // namespace tess::detail
