// Arrays of chares and their proxies. A proxy is a small value: it can be stored, sent, and used on
// every PE.
//
//     // dense: 64 elements, each Block(size)
//     auto blocks = tess::create<Block>(tess::range(8, 8), size);
//     // sparse: elements exist once they are inserted or demanded
//     auto voxels = tess::create<Voxel>(tess::sparse);
//     blocks[{3, 4}].send<&Block::step>(0);
//     blocks.broadcast<&Block::step>(0);
#pragma once

#include "runtime/ask.hpp"
#include "runtime/chare.hpp"
#include "runtime/collections/call.hpp"
#include "runtime/collections/moving.hpp"
#include "runtime/collections/routing.hpp"
#include "runtime/collections/saving.hpp"
#include "runtime/messages/read_all.hpp"
#include "runtime/priority.hpp"
#include "runtime/scheduler/pe_action.hpp"
#include "runtime/timer.hpp"

namespace tess {

/// A chare that can be packed on one PE and rebuilt on another.
template <class C>
concept Migratable = std::is_default_constructible_v<C> && serialization::HasSerialize<C>;

namespace detail {

/// A member of a group.
template <class C>
concept OnePerPe = requires { C::one_per_pe; };

/// A class that a checkpoint leaves out: `static constexpr bool in_checkpoints = false;`.
template <class C>
concept NotSaved = requires { requires !C::in_checkpoints; };

/// After a restart on another number of PEs a member of a group takes over the state of another one.
template <class C>
concept Absorbs = requires(C& member, C& other) { member.absorb(std::move(other)); };

/// The priority of a message is that which its class gives the entry method.
struct OfEntry {};

/// Indices spread over all PEs.
template <class Index>
[[nodiscard]] PeId home_by_hash(const Index& index, std::int32_t n_pes) {
  // The high bits: hash tables use the low ones for the slot, which would cluster.
  return PeId{static_cast<std::int32_t>((IndexHash<Index>()(index) >> 32U) %
                                        static_cast<std::uint64_t>(n_pes))};
}

template <class C>
class Array final : public ArrayOf<typename C::Index> {
 public:
  using Index = typename C::Index;
  using Base = ArrayOf<Index>;
  using Indexed = typename Base::Indexed;

  Array(Pe& pe, CollectionId id, const Range& range)
      : Base(pe, id, plain_name(name_of_type<C>), range) {}
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  ~Array() override { this->destroy_all(); }

  [[nodiscard]] PeId home(const Index& index) const override {
    if (this->index_map() != nullptr) [[unlikely]]
      return this->mapped_home(&index);
    if constexpr (requires { C::place(index, this->pe_.n_pes()); }) {
      const PeId at = C::place(index, this->pe_.n_pes());
      TESS_CHECK(at.value >= 0 && at.value < this->pe_.n_pes(), "place() of ", this->name(),
                 " puts the element ", index_text(index), " on ", at, ", but the run has ",
                 this->pe_.n_pes(), this->pe_.n_pes() == 1 ? " PE" : " PEs");
      return at;
    } else {
      if constexpr (Coordinates<Index>) {
        if (const std::int64_t rank = rank_in(this->range(), index); rank >= 0)
          return this->block_map().home(rank);
      }
      return home_by_hash(index, this->pe_.n_pes());
    }
  }

  /// Constructs the elements of the initial range whose home is this PE.
  template <class... Args>
  void make_initial(const Args&... args) {
    // A class without a default constructor may have a sparse array: it has no initial elements.
    constexpr bool constructs =
        sizeof...(Args) > 0 || OnePerPe<C> || std::is_default_constructible_v<C>;
    if constexpr (Coordinates<Index> && constructs) {
      const auto size = static_cast<std::int64_t>(this->range().size());
      std::int64_t first = 0, last = size;
      if constexpr (OnePerPe<C>) {
        first = this->pe_.id().value;
        last = first + 1;
      } else if (!requires(Index i) { C::place(i, 1); } && this->index_map() == nullptr) {
        const auto rank = static_cast<std::int64_t>(this->pe_.id().value);
        const std::int64_t n_pes = this->pe_.n_pes();
        first = (rank * size + n_pes - 1) / n_pes;
        last = ((rank + 1) * size + n_pes - 1) / n_pes;
      }
      this->construct_initial([&] {
        for (std::int64_t rank = first; rank < last; ++rank) {
          const auto index = index_at<Index>(this->range(), rank);
          if (home(index) != this->pe_.id()) continue;
          this->construct(index, Version{1, 1}, [&args...] { return make_chare<C>(args...); });
        }
      });
    }
  }

  /// The runtime's part of an element: the user's class may have members of the same names.
  static Indexed& own(C& element) { return element; }

  void take_in(Arrival<C>& arrival) {
    if (arrival.element == nullptr) {
      if constexpr (Migratable<C>) {
        const std::span<const std::byte> state(arrival.state.data(), arrival.state.size());
        Reader ar(state);
        const auto index = ar.template take<Index>();
        arrival.element = construct_again(index);
        ar(own(*arrival.element).state_);
        this->unpack_record(*arrival.element, ar);
        [[maybe_unused]] const auto sent = state.last(ar.remaining());
        read_members(*arrival.element, ar);
#ifdef TESS_CHECKS_ALL
        const std::string difference = difference_from_bytes(sent, *arrival.element);
        TESS_CHECK(difference.empty(), index_text(index), " of ", difference);
#endif
      }
    }
    this->add_arrived(std::exchange(arrival.element, nullptr), arrival.from,
                      std::move(arrival.memberships));
  }

  static void pack_element(C& element, Writer& ar) {
    if constexpr (Migratable<C>) {
      ar(own(element).index_, own(element).state_);
      Base::pack_record(own(element), ar);
      element.serialize(ar);
    }
  }

  /// An element that arrives after the end of the array is destroyed.
  static void drop(Pe& pe, Arrival<C>& arrival) {
    if (arrival.element != nullptr) {
      Base::drop_record(pe, own(*arrival.element));
    } else {
      Reader ar(std::span<const std::byte>(arrival.state.data(), arrival.state.size()));
      (void)ar.template take<Index>();
      Base::drop_record(pe, ar);
    }
    tess::detail::drop(pe, arrival.memberships);
    pe.completion().processed(arrival.epoch);
    if (arrival.element == nullptr) return;
    // The part of the array that the element left may have been freed, but its destructor may call
    // array().
    Array gone(pe, arrival.collection, Range{});
    own(*arrival.element).collection_ = &gone;
    delete std::exchange(arrival.element, nullptr);
  }

  void resume(Element& element) override {
    if constexpr (ResumesFromSync<C>) {
      C& chare = static_cast<C&>(element);
      auto* message = Awakening<C>::make(this->pe_, this->id(), own(chare).index_);
      Base::continue_wait(own(chare), *message, message->led_by);
      this->post(message);
    } else {
      Base::resume(element);
    }
  }
  [[nodiscard]] std::optional<std::array<double, 3>> position_of(
      const Element& element) const override {
    if constexpr (requires(const C& c) { c.balance_position(); }) {
      return static_cast<const C&>(element).balance_position();
    } else {
      return Base::position_of(element);
    }
  }
  [[nodiscard]] std::string state_of(const Element& element) const override {
    if constexpr (requires(const C& c) { c.describe_state(); })
      return static_cast<const C&>(element).describe_state();
    return Base::state_of(element);
  }
  [[nodiscard]] std::uint64_t packed_bytes(Element& element) const override {
    Writer count{std::span<std::byte>()};
    pack_element(static_cast<C&>(element), count);
    return count.n_bytes();
  }

  [[nodiscard]] bool migratable() const override { return Migratable<C> && !OnePerPe<C>; }
  [[nodiscard]] const CollectionKind& kind() const override { return kind_; }

  void take_saved(std::uint32_t incarnation, bool alive, Reader& ar) override {
    auto index = ar.template take<Index>();
    if (!alive) return this->restore_destroyed(index, incarnation);
    if constexpr (Migratable<C>) {
      if constexpr (OnePerPe<C>) index = Index{this->pe_.id().value};
      std::unique_ptr<C> element(construct_again(index));
      read_members(*element, ar);
      if (!OnePerPe<C> || this->n_local() == 0)
        return this->add_restored(*element.release(), incarnation);
      own(*element).collection_ = this;
      if constexpr (Absorbs<C>)
        static_cast<C&>(*this->elements().front()).absorb(std::move(*element));
    }
  }
  void restored() override {
    if constexpr (OnePerPe<C> && Migratable<C>)
      if (this->n_local() == 0)
        this->construct(Index{this->pe_.id().value}, Version{1, 1}, [] { return make_chare<C>(); });
  }

  void end() override {
    if constexpr (requires(C& member) { member.group_ends(); })
      for (Element* element : this->elements()) static_cast<C*>(element)->group_ends();
    Base::end();
  }
  [[nodiscard]] std::string index_text_of(const Element& element) const override {
    return OnePerPe<C> ? text("[", this->pe_.id(), "]") : Base::index_text_of(element);
  }
  [[nodiscard]] std::string constructed_text(const void* index) const override {
    return OnePerPe<C> ? text(this->name(), "[", this->pe_.id(), "]")
                       : Base::constructed_text(index);
  }

 protected:
  Indexed* construct_default() override {
    if constexpr (std::is_default_constructible_v<C>) {
      return make_chare<C>();
    } else {
      TESS_CHECK(false, this->name(),
                 " has no default constructor: it cannot be created on demand");
      return nullptr;
    }
  }
  void destroy(Indexed& element) override { delete &static_cast<C&>(element); }
  void ship(Indexed& element, PeId to, Memberships&& memberships) override {
    TESS_CHECK(Migratable<C>, this->name(),
               " cannot migrate: it needs a default constructor and serialize()");
    Pe& pe = this->pe_;
    auto* arrival = pe.stamp(new Arrival<C>());
    arrival->action = &Arrival<C>::entry;
    arrival->collection = this->id();
    arrival->from = pe.id();
    arrival->element = &static_cast<C&>(element);
    arrival->memberships = std::move(memberships);
#ifdef TESS_CHECKS_ALL
    // Within a process the element is also rebuilt from its bytes, so members that serialize()
    // omits are lost on one PE as they are on a cluster.
    arrival->pack_state();
#endif
    pe.send(to, arrival);
  }
  void save_element(Element& element, Writer& ar) override {
    if constexpr (Migratable<C>) {
      ar(own(static_cast<C&>(element)).index_);
      static_cast<C&>(element).serialize(ar);
    }
  }
  [[nodiscard]] PeId home_of_saved(Reader ar) const override {
    return OnePerPe<C> ? this->pe_.id() : home(ar.template take<Index>());
  }
  [[nodiscard]] DeadLetters dead_letters() const override {
    if constexpr (requires { C::dead_letters; }) {
      return C::dead_letters;
    } else {
      return DeadLetters::report;
    }
  }

 private:
  /// Constructs an element that is to be read from bytes.
  C* construct_again(const Index& index) {
    const Pe::Construction construction(this->pe_, &index, this);
    C* const element = make_chare<C>();
    // The first construction has already done what the constructor asks for.
    this->drop_after_construction();
    own(*element).migrate_to_ = PeId{-1};
    own(*element).destroy_requested_ = false;
    return element;
  }
  void read_members(C& element, Reader& ar) {
    read_all(
        ar, [&] { return this->name() + index_text(own(element).index_); },
        [&element](Reader& rest) {
          element.serialize(rest);
          return true;
        });
  }
  static std::unique_ptr<Collection> make(Pe& pe, CollectionId id, const Range& range) {
    return std::make_unique<Array>(pe, id, range);
  }
  static inline const CollectionKind kind_{naming::name_of<C>(),
                                           NotSaved<C>     ? Saving::skipped
                                           : Migratable<C> ? Saving::elements
                                                           : Saving::impossible,
                                           !OnePerPe<C> ? CollectionKind::Members::of_array
                                           : Absorbs<C> ? CollectionKind::Members::absorbed
                                                        : CollectionKind::Members::fixed,
                                           &make};
};

template <class C>
void Arrival<C>::pack(Envelope& envelope, Writer& ar) {
  auto& arrival = static_cast<Arrival&>(envelope);
  if (arrival.element != nullptr) arrival.pack_state();
  ar(arrival.collection, arrival.from, arrival.state, arrival.memberships);
}

template <class C>
std::uint64_t Arrival<C>::drop(Pe& pe, Envelope& envelope) {
  Array<C>::drop(pe, static_cast<Arrival&>(envelope));
  return 0;
}

template <class C>
void Arrival<C>::pack_state() {
  Writer count{std::span<std::byte>()};
  Array<C>::pack_element(*element, count);
  state.resize(count.n_bytes());
  Writer write{std::span(state.data(), state.size())};
  Array<C>::pack_element(*element, write);
  delete std::exchange(element, nullptr);
}

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
    return after(delay, [to = *this, arguments = typename detail::EntryTraits<F>::Arguments(
                                         std::forward<Args>(args)...)] {
      std::apply([&to](const auto&... argument) { to.template send<F>(argument...); }, arguments);
    });
  }
  /// Calls member function F of the element and returns what `co_await` waits for: the value that F
  /// returns, or the end of its coroutine. The call is sent at once. A tess::Error that F throws is
  /// thrown in the asker, and so is one if the element was destroyed. If there is no element yet,
  /// the call waits at the home of the index.
  template <auto F, class... Args>
  [[nodiscard]] Ask<C, F> ask(Args&&... args) const {
    return ask_from<F>(detail::ReplyPlace(), std::forward<Args>(args)...);
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
    construct(current_pe().id(), detail::Demand::insert, std::forward<Args>(args)...);
  }
  /// Creates the element on another PE; otherwise like insert().
  template <class... Args>
  void insert_on(PeId pe, Args&&... args) const {
    construct(pe, detail::Demand::insert, std::forward<Args>(args)...);
  }
  /// Creates the element on this PE unless it exists.
  template <class... Args>
  void insert_if_absent(Args&&... args) const {
    construct(current_pe().id(), detail::Demand::insert_if_absent, std::forward<Args>(args)...);
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
  /// The PE to which a message for the element is sent from this PE.
  [[nodiscard]] PeId next_pe() const { return branch(current_pe()).next_pe(index_); }

  /// A target for results: entry method F of this element.
  template <auto F>
  [[nodiscard]] auto target() const {
    using T = typename decltype(detail::target_value<F, NoValue>())::type;
    if constexpr (Bitwise<Index>) {
      return detail::make_target<T>(target_kind<F, T>, std::in_place, collection_, index_);
    } else {
      return detail::make_target<T>(target_kind<F, T>, to_bytes(std::tuple(collection_, index_)));
    }
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
  [[nodiscard]] detail::Array<C>& branch(Pe& pe) const {
    detail::Collection* collection = detail::find_collection(pe, collection_);
    TESS_CHECK(collection != nullptr, "the array of this proxy is not known on ", pe.id(),
               ": it was created by a message that has not arrived");
    return *static_cast<detail::Array<C>*>(collection);
  }

  friend class PrioritisedElement<C, Index>;

  template <auto F, class Place, class... Args>
  [[nodiscard]] Ask<C, F> ask_from(Place place, Args&&... args) const {
    static_assert(detail::check_ask<C, F, Args...>());
    Pe& pe = current_pe();
    Ask<C, F> reply(collection_, index_);
    static_cast<detail::ReplyPlace&>(place) = reply.place();
    post_message(pe, detail::AskCall<C, Place, F>::make(pe, collection_, index_, place,
                                                        std::forward<Args>(args)...));
    return reply;
  }

  // `Of` is OfEntry, or the Priority that the sender gave.

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
      send_on_demand<F>(
          of, creates == detail::Creates::here ? detail::Demand::here : detail::Demand::home,
          std::forward<Args>(args)...);
    }
  }
  template <auto F, class Of, class... Args>
  void send_on_demand(Of of, detail::Demand demand, Args&&... args) const {
    static_assert(!detail::OnePerPe<C>, "a group has all its members: none is created on demand");
    static_assert(std::is_default_constructible_v<C>,
                  "a chare that is created on demand needs a default constructor");
    post<F>(of, demand, std::forward<Args>(args)...);
  }
  template <auto F, class Of, class... Args>
  void post(Of of, detail::Demand demand, Args&&... args) const {
    static_assert(detail::check_entry<C, F, Args...>());
    Pe& pe = current_pe();
    auto* message = [&]<class... P>(std::tuple<P...>*) {
      if constexpr (std::is_same_v<Of, Priority>) {
        return detail::PrioritisedCall<C, F>::make(
            pe, collection_, index_, of.value,
            detail::as_parameter<P>(std::forward<Args>(args))...);
      } else {
        return detail::Call<C, F>::make(pe, collection_, index_,
                                        detail::as_parameter<P>(std::forward<Args>(args))...);
      }
    }(static_cast<typename detail::EntryTraits<F>::Arguments*>(nullptr));
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
  /// Calls the entry method inside the caller's. Returns false, and takes no argument, if it must be
  /// queued.
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
    array->run_now(*element, detail::Call<C, F>::entry, [&] {
      std::apply(
          [element](auto&... argument) {
            (void)(static_cast<C*>(element)->*F)(std::move(argument)...);
          },
          arguments);
    });
    return true;
  }
  void post_message(Pe& pe, detail::ElementMessage<Index>* message) const {
    pe.completion().sent(message->epoch);
    if (detail::Collection* collection = detail::find_collection(pe, collection_);
        collection != nullptr) [[likely]] {
      static_cast<detail::Array<C>*>(collection)->post(message);
    } else {
      TESS_CHECK(collection_ != CollectionId{}, "a message to an empty ElementProxy<",
                 name_of_type<C>, ">: assign array[index] to it first");
      pe.send_here(message);  // it waits until the array is known here
    }
  }
  template <class... Args>
  void construct(PeId where, detail::Demand demand, Args&&... args) const {
    static_assert(std::is_constructible_v<C, std::decay_t<Args>...>,
                  "the chare has no constructor that takes these arguments");
    Pe& pe = current_pe();
    detail::check_exists(pe, where);
    auto* message = detail::Construction<C, std::decay_t<Args>...>::make(
        pe, collection_, index_, std::forward<Args>(args)...);
    message->demand = demand;
    message->ask = true;
    message->asker = where;
    if (where == pe.id()) {
      post_message(pe, message);
    } else {
      pe.completion().sent(message->epoch);
      pe.send(where, message);
    }
  }
  template <class Kind, class... Args>
  void system(Args... args) const {
    Pe& pe = current_pe();
    post_message(pe, Kind::make(pe, collection_, index_, args...));
  }

  template <auto F, class T>
  static void call_target(const Callback<T>& callback, T&& value) {
    const auto [collection, index] = from_bytes<std::tuple<CollectionId, Index>>(callback.where());
    const ElementProxy element(collection, index);
    if constexpr (std::is_same_v<T, NoValue>) {
      element.template queue<F>(detail::OfEntry());
    } else {
      element.template queue<F>(detail::OfEntry(), std::forward<T>(value));
    }
  }
  template <auto F, class T>
  static std::string describe_target(const Callback<T>& callback) {
    const auto [collection, index] = from_bytes<std::tuple<CollectionId, Index>>(callback.where());
    return text(plain_name(naming::value<F>()), " of ", plain_name(name_of_type<C>),
                index_text(index));
  }
  template <auto F, class T>
  static inline const typename Callback<T>::Kind target_kind{
      naming::name_of<&ElementProxy::call_target<F, T>>(), &ElementProxy::call_target<F, T>,
      &ElementProxy::describe_target<F, T>};

  CollectionId collection_{};
  Index index_{};
};

namespace detail {
/// Calls entry method F of all elements with the value of a callback, which may be no value.
template <auto F, class Proxy, class T>
void broadcast_value(const Proxy& all, T&& value) {
  if constexpr (std::is_same_v<T, NoValue>) {
    all.template broadcast<F>();
  } else {
    all.template broadcast<F>(std::forward<T>(value));
  }
}
}  // namespace detail

/// The proxy of a whole array.
template <class C>
class ArrayProxy {
 public:
  ArrayProxy() = default;
  explicit ArrayProxy(CollectionId id) : id_(id) {}

  [[nodiscard]] CollectionId id() const { return id_; }
  /// The element of this index. (A template, so that a proxy may be a member of a class before C is
  /// complete.)
  template <class Of = C>
  [[nodiscard]] ElementProxy<Of> operator[](const typename Of::Index& index) const {
    return ElementProxy<Of>(id_, index);
  }
  /// {1} would be (1, 0) otherwise.
  template <class Of = C>
    requires(n_axes_of<typename Of::Index> > 1)
  void operator[](std::int32_t /*x*/) const {
    static_assert(sizeof(Of) == 0, "an index has a number for each axis: array[{x, y}]");
  }
  template <class Of = C>
  void operator[](const typename detail::FewerAxes<n_axes_of<typename Of::Index>>::type&) const =
      delete;

  /// The element of this index if it is on this PE now, otherwise null. It may leave or be destroyed
  /// once the current message is done.
  template <class Of = C>
  [[nodiscard]] Of* local(const typename Of::Index& index) const {
    return static_cast<Of*>(here().find(index));
  }

  /// The number of elements that the array was created with. On a PE that the proxy reached before
  /// the array it is not known, which ends the job: create the array inside an awaited epoch.
  [[nodiscard]] std::int64_t size() const {
    return static_cast<std::int64_t>(here().range().size());
  }
  [[nodiscard]] const Range& range() const { return here().range(); }

  /// Calls entry method F of every element that exists when the broadcast reaches its PE.
  template <auto F, class... Args>
  void broadcast(Args&&... args) const {
    broadcast_as<F>(detail::OfEntry(), std::forward<Args>(args)...);
  }
  /// The same array for broadcasts with a priority.
  [[nodiscard]] PrioritisedArray<C> with(Priority priority) const { return {*this, priority}; }

  /// Ends the array: on every PE its elements are destroyed and its memory is freed, including that
  /// of its balancer. Messages, broadcasts, contributions and elements that are still under way to
  /// it are dropped where they arrive; messages and broadcasts count as dead letters. An element
  /// with a waiting coroutine gets no more messages and is destroyed once the coroutine is done.
  /// The current epoch waits until all PEs have freed the array. Ending an array again has no
  /// effect.
  void destroy() const { detail::end_collection(id_); }
  /// True if the array was destroyed and this PE has freed its part, or does so once the waiting
  /// coroutines of its elements are done.
  [[nodiscard]] bool ended() const { return current_pe().ended(id_); }

  /// A target for results: entry method F of all elements.
  template <auto F>
  [[nodiscard]] auto target() const {
    using T = typename decltype(detail::target_value<F, NoValue>())::type;
    return detail::make_target<T>(target_kind<F, T>, std::in_place, id_);
  }

  /// The part of the array on this PE with its local elements, for libraries and tests.
  [[nodiscard]] detail::Array<C>& here() const {
    detail::Collection* collection = detail::find_collection(current_pe(), id_);
    TESS_CHECK(collection != nullptr, "the array of this proxy ",
               current_pe().ended(id_) ? "was destroyed" : "is not known yet", " on ",
               current_pe().id(),
               current_pe().ended(id_)
                   ? ""
                   : ": create it inside an awaited epoch, or send its size with the proxy");
    return *static_cast<detail::Array<C>*>(collection);
  }

  friend auto operator<=>(const ArrayProxy&, const ArrayProxy&) = default;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id_);
  }

 private:
  friend class PrioritisedArray<C>;

  template <auto F, class Of, class... Args>
  void broadcast_as(Of of, Args&&... args) const {
    static_assert(detail::check_broadcast<C, F, Args...>());
    using Arguments = typename detail::EntryTraits<F>::Arguments;
    auto arguments = detail::as_parameters<Arguments>(std::forward<Args>(args)...);
    if constexpr (std::is_same_v<Of, Priority>) {
      detail::start_broadcast(id_, detail::SharedCall(new detail::PrioritisedCallOfAll<C, F>(
                                       of, std::move(arguments))));
    } else {
      detail::start_broadcast(
          id_, detail::SharedCall(new detail::CallOfAll<C, F>(std::move(arguments))));
    }
  }

  template <auto F, class T>
  static void call_target(const Callback<T>& callback, T&& value) {
    detail::broadcast_value<F>(ArrayProxy(from_bytes<CollectionId>(callback.where())),
                               std::forward<T>(value));
  }
  template <auto F, class T>
  static std::string describe_target(const Callback<T>& /*callback*/) {
    return text(plain_name(naming::value<F>()), " of all elements of ",
                plain_name(name_of_type<C>));
  }
  template <auto F, class T>
  static inline const typename Callback<T>::Kind target_kind{
      naming::name_of<&ArrayProxy::call_target<F, T>>(), &ArrayProxy::call_target<F, T>,
      &ArrayProxy::describe_target<F, T>};

  CollectionId id_{};
};

namespace detail {

template <class C, class... Args>
struct CreateArray {
  CollectionId id;
  Range range;
  EpochId epoch;
  std::tuple<Args...> args;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id, range, epoch, args);
  }
};

/// Makes the part of an array on this PE, with its initial elements.
template <class C, class... Args>
void make_array(Pe& pe, const CreateArray<C, Args...>& m,
                std::shared_ptr<const IndexMap> map = nullptr) {
  auto made = std::make_unique<Array<C>>(pe, m.id, m.range);
  Array<C>& array = *made;
  array.set_index_map(std::move(map));
  pe.add(std::move(made));
  std::apply([&array](const Args&... args) { array.make_initial(args...); }, m.args);
  pe.completion().processed(m.epoch);
}
template <class C, class... Args>
void create_arrives(Pe& pe, CreateArray<C, Args...>&& m) {
  make_array(pe, m);
}

/// What happens to messages to an ended collection of C: they count as dead letters, unless the
/// class defines late_messages.
template <class C>
constexpr LateMessages late_messages_of() {
  if constexpr (requires { C::late_messages; }) {
    return C::late_messages;
  } else {
    return LateMessages::counted;
  }
}

/// Passes the message to its handler on all PEs; here at once, so that the proxy is valid from now on.
template <auto handler, class Message>
void create_on_all(Pe& pe, Message message) {
  for (std::int32_t to = 0; to < pe.n_pes(); ++to) {
    pe.completion().sent(pe.context().epoch);
    if (PeId{to} != pe.id()) send_system<handler>(pe, PeId{to}, message);
  }
  handler(pe, std::move(message));
}

template <class C, class... Args>
CreateArray<C, std::decay_t<Args>...> new_array(Pe& pe, const Range& range, Args&&... args) {
  return {pe.new_collection_id(late_messages_of<C>()),
          range,
          pe.context().epoch,
          {std::forward<Args>(args)...}};
}

template <class C, class... Args>
CollectionId create_collection(const Range& range, Args&&... args) {
  Pe& pe = current_pe();
  auto array = new_array<C>(pe, range, std::forward<Args>(args)...);
  const CollectionId id = array.id;
  create_on_all<&create_arrives<C, std::decay_t<Args>...>>(pe, std::move(array));
  return id;
}

/// Checks the arguments of create().
template <class C, class... Args>
void check_creation(const Range& range) {
  // Without coordinates there are no initial elements, and insert() has its own arguments.
  static_assert(
      (!Coordinates<typename C::Index> && sizeof...(Args) == 0) ||
          std::is_constructible_v<C, const std::decay_t<Args>&...>,
      "the chare has no constructor that takes these arguments (each element gets a copy)");
  if constexpr (Coordinates<typename C::Index>) {
    TESS_CHECK(range.n_axes == 0 || range.n_axes == n_axes_of<typename C::Index>, "a range of ",
               range.n_axes, " axes for an index of ", n_axes_of<typename C::Index>);
  } else {
    TESS_CHECK(range.n_axes == 0,
               "an array with this type of index starts sparse: create<C>(tess::sparse)");
  }
}

}  // namespace detail

/// Creates an array on all PEs. Each element of the range is constructed with these arguments on
/// the home PE of its index. Returns immediately: messages wait on PEs that do not know the array
/// yet.
template <class C, class... Args>
ArrayProxy<C> create(const Range& range, Args&&... args) {
  detail::check_creation<C, Args...>(range);
  return ArrayProxy<C>(detail::create_collection<C>(range, std::forward<Args>(args)...));
}
/// The same of tess::sparse: no elements yet. The arguments of constructors are those of insert().
template <class C>
ArrayProxy<C> create(const Sparse& range) {
  return ArrayProxy<C>(detail::create_collection<C>(range));
}

}  // namespace tess

template <class C, class Index>
struct std::hash<tess::ElementProxy<C, Index>> {
  std::size_t operator()(const tess::ElementProxy<C, Index>& proxy) const { return proxy.hash(); }
};
template <class C>
struct std::hash<tess::ArrayProxy<C>> {
  std::size_t operator()(const tess::ArrayProxy<C>& proxy) const {
    return std::hash<tess::CollectionId>()(proxy.id());
  }
};
