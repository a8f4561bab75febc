// The part of an array of C on one PE: what ArrayOf leaves to the class. It constructs the initial
// elements at their homes, packs an element into bytes and rebuilds it from them (a migration, a
// checkpoint), and calls the optional members that a class may define: place(),
// balance_position(), describe_state(), resume_from_sync(), group_ends(), absorb(). A group is an
// array of one element per PE. Everything that needs only the type of the index is in array_of.hpp.
#pragma once

#include "runtime/arrays/elements/make_chare.hpp"
#include "runtime/arrays/typed/array_of.hpp"
#include "runtime/arrays/typed/arrival.hpp"
#include "runtime/arrays/typed/call.hpp"
#include "runtime/arrays/typed/moving.hpp"
#include "runtime/arrays/typed/routing.hpp"
#include "runtime/arrays/typed/saving.hpp"
#include "runtime/wire/messages/class_options.hpp"

#include <array>
#include <concepts>
#include <cstdint>
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

/// A member of a process group: it has what the PEs of its process share.
template <class C>
concept SharedInProcess = requires { C::shared_in_process; };

/// After a restart on another number of PEs a member of a group takes over the state of another
/// one.
template <class C>
concept Absorbs = requires(C& member, C& other) { member.absorb(std::move(other)); };

/// A class that chooses the homes of its elements.
template <class C>
concept ChoosesHomes = requires(const typename C::Index& index, std::int32_t n_pes) {
  { C::place(index, n_pes) } -> std::same_as<PeId>;
};

/// A class with a public place() for indices that is not static, lacks the number of PEs or gives a
/// number: it would be ignored.
template <class C>
concept ChoosesHomesWrongly =
    !ChoosesHomes<C> && (
                            requires(C& chare, const typename C::Index& index) {
                              { chare.place(index) } -> std::same_as<PeId>;
                            } ||
                            requires(C& chare, const typename C::Index& index, std::int32_t n_pes) {
                              { chare.place(index, n_pes) } -> std::same_as<PeId>;
                            } ||
                            requires(const typename C::Index& index, std::int32_t n_pes) {
                              { C::place(index, n_pes) } -> std::same_as<std::int32_t>;
                            });

/// A class that says what happens to messages to its destroyed elements.
template <class C>
concept SaysDeadLetters =
    requires { typename std::integral_constant<DeadLetters, C::dead_letters>; };

/// A class that describes the state of an element in reports.
template <class C>
concept DescribesState = requires(const C& c) {
  { c.describe_state() } -> std::convertible_to<std::string>;
};

/// Refuses options of the class that would be ignored.
template <class C>
consteval bool check_options() {
  static_assert(
      !ChoosesHomesWrongly<C>,
      "place() of a chare is `static tess::PeId place(const Index&, std::int32_t n_pes)`");
  static_assert(
      SaysDeadLetters<C> || !NamesDeadLetters<C>,
      "dead_letters of a chare is `static constexpr auto dead_letters = "
      "tess::DeadLetters::…` and public; a member for another purpose needs another name");
  static_assert(DescribesState<C> || !NamesDescribeState<C>,
                "describe_state() of a chare is `std::string describe_state() const` and public; a "
                "member for another purpose needs another name");
  return true;
}

/// Indices spread over all PEs.
template <class Index>
[[nodiscard]] PeId home_by_hash(const Index& index, std::int32_t n_pes) {
  // The high bits: hash tables use the low ones for the slot, which would cluster.
  return PeId{static_cast<std::int32_t>((IndexHash<Index>()(index) >> 32U) %
                                        static_cast<std::uint64_t>(n_pes))};
}

/// Names the action of arriving elements of C.
template <class C>
struct ArrivalOf;

template <class C>
class Array final : public ArrayOf<typename C::Index> {
 public:
  using Index = typename C::Index;
  using Base = ArrayOf<Index>;
  using Indexed = typename Base::Indexed;

  Array(Pe& pe, CollectionId id, const Range& range)
      : Base(pe, id, plain_name(name_of_type<C>), range) {
    static_assert(check_options<C>());
  }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  ~Array() override { this->destroy_all(); }

  [[nodiscard]] PeId home(const Index& index) const override {
    if (this->index_map() != nullptr) [[unlikely]]
      return this->mapped_home(&index);
    if constexpr (ChoosesHomes<C>) {
      const PeId at = placed(index);
      if (at.value < 0 || at.value >= this->pe_.n_pes()) this->refuse_place(index_text(index), at);
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
      constexpr bool places = !OnePerPe<C> && ChoosesHomes<C>;
      this->construct_initial([&] {
        const std::pair<std::int64_t, std::int64_t> ranks = this->ranks_of_blocks(places);
        for (std::int64_t rank = ranks.first; rank < ranks.second; ++rank) {
          const auto index = index_at<Index>(this->range(), rank);
          if (home(index) != this->pe_.id()) continue;
          this->construct(index, Version{1, 1}, [&args...] { return make_chare<C>(args...); });
        }
      });
    }
  }

  /// The runtime's part of an element: the user's class may have members of the same names.
  static Indexed& own(C& element) { return element; }

  /// Writes an element: its index, its state and the user's members.
  static void pack_element(Element& element, Writer& ar) {
    if constexpr (Migratable<C>) {
      static_assert(serialization::serialises_all<C, Indexed>(),
                    "serialize() is inherited from a base class and may leave out members of this "
                    "class: define it here, and call that of the base class in it");
      C& chare = static_cast<C&>(element);
      ar(own(chare).index_, own(chare).state_);
      BalancedElements::pack_record(own(chare), ar);
      chare.serialize(ar);
    }
  }

  void resume(Element& element) override {
    if constexpr (requires(C& c) { c.resume_from_sync(); }) {
      C& chare = static_cast<C&>(element);
      auto* message = Awakening<C>::make(this->pe_, this->id(), own(chare).index_);
      const Counted wait = this->balanced().continue_wait(own(chare), *message, message->led_by);
      message->demand = Demand::member;  // it brings no destroyed element back
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
    if constexpr (DescribesState<C>) return static_cast<const C&>(element).describe_state();
    return Base::state_of(element);
  }
  [[nodiscard]] bool migratable() const override { return Migratable<C> && !OnePerPe<C>; }
  [[nodiscard]] const CollectionKind& kind() const override { return kind_; }
  [[nodiscard]] static const CollectionKind& its_kind() { return kind_; }

  void take_saved(std::uint32_t incarnation, bool alive, Reader& ar) override {
    auto index = ar.template take<Index>();
    if (!alive) return this->restore_destroyed(index, incarnation);
    if constexpr (Migratable<C>) {
      if constexpr (OnePerPe<C>) index = Index{this->pe_.id().value};
      std::unique_ptr<Indexed> element(this->construct_again(index));
      this->read_saved_members(*element, ar);
      if (!OnePerPe<C> || this->n_local() == 0)
        return this->add_restored(*element.release(), incarnation);
      element->collection_ = this;
      if constexpr (Absorbs<C>)
        static_cast<C&>(*this->elements().front()).absorb(std::move(static_cast<C&>(*element)));
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
  [[nodiscard]] const ArrivalAction* arrival_action() const override {
    return Migratable<C> ? &arrival_ : nullptr;
  }
#ifdef TESS_CHECKS_ALL
  [[nodiscard]] std::string difference_from(std::span<const std::byte> sent,
                                            Indexed& element) const override {
    if constexpr (Migratable<C>) return difference_from_bytes(sent, static_cast<C&>(element));
    return {};
  }
#endif
  void read_members(Element& element, Reader& ar) const override {
    if constexpr (Migratable<C>) static_cast<C&>(element).serialize(ar);
  }
  void save_element(Element& element, Writer& ar) override {
    if constexpr (Migratable<C>) {
      ar(own(static_cast<C&>(element)).index_);
      static_cast<C&>(element).serialize(ar);
    }
  }
  [[nodiscard]] PeId home_of_saved(Reader ar) const override {
    const auto index = ar.template take<Index>();
    if constexpr (OnePerPe<C>) {
      return PeId{index.x % this->pe_.n_pes()};
    } else {
      return home(index);
    }
  }
  [[nodiscard]] DeadLetters dead_letters() const override {
    if constexpr (SaysDeadLetters<C>) {
      return C::dead_letters;
    } else {
      return DeadLetters::report;
    }
  }

 private:
  /// What place() of the class gives.
  [[nodiscard]] PeId placed(const Index& index) const {
    return call_user([&] { return C::place(index, this->pe_.n_pes()); });
  }
  static std::unique_ptr<Collection> make(Pe& pe, CollectionId id, const Range& range) {
    return std::make_unique<Array>(pe, id, range);
  }
  static inline const CollectionKind kind_{naming::name_of<C>(),
                                           NotSaved<C>          ? Saving::skipped
                                           : SharedInProcess<C> ? Saving::shared
                                           : Migratable<C>      ? Saving::elements
                                                                : Saving::impossible,
                                           !OnePerPe<C> ? CollectionKind::Members::of_array
                                           : Absorbs<C> ? CollectionKind::Members::absorbed
                                                        : CollectionKind::Members::fixed,
                                           &make};
  static inline const ArrivalAction arrival_{naming::name_of<ArrivalOf<C>>(),
                                             std::type_identity<Index>(), &pack_element, kind_};
};

}  // namespace detail

}  // namespace tess
