// The part of an array of C on one PE: what ArrayOf leaves to the class. It constructs the initial
// elements at their homes, packs an element into bytes and rebuilds it from them (a migration, a
// checkpoint), and calls the optional members that a class may define: place(),
// balance_position(), describe_state(), resume_from_sync(), group_ends(), absorb(). A group is an
// array of one element per PE. Everything that needs only the type of the index is in array_of.hpp.
#pragma once

#include "runtime/collections/arrays/array_of.hpp"
#include "runtime/collections/arrays/call.hpp"
#include "runtime/collections/arrays/moving.hpp"
#include "runtime/collections/arrays/routing.hpp"
#include "runtime/collections/arrays/saving.hpp"
#include "runtime/collections/elements/make_chare.hpp"
#include "runtime/messages/read_all.hpp"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace tess {

/// A chare that can be packed on one PE and rebuilt on another.
template <class C>
concept Migratable = std::is_default_constructible_v<C> && serialization::HasSerialize<C>;

namespace detail {

/// It derives from Chare or Group.
template <class C>
concept IsChare = std::is_base_of_v<Element, C> && requires { typename C::Index; };

/// A member of a group.
template <class C>
concept OnePerPe = requires { C::one_per_pe; };

/// A class that a checkpoint leaves out: `static constexpr bool in_checkpoints = false;`.
template <class C>
concept NotSaved = requires { requires !C::in_checkpoints; };

/// After a restart on another number of PEs a member of a group takes over the state of another one.
template <class C>
concept Absorbs = requires(C& member, C& other) { member.absorb(std::move(other)); };

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
    if constexpr (requires(C& c) { c.resume_from_sync(); }) {
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

}  // namespace tess
