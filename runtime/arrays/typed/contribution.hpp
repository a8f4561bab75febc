// Contributions of elements to reductions, for chares and for members of groups. The key orders the
// values of reductions in order: an index, or a PE.
#pragma once

#include "runtime/arrays/collection.hpp"
#include "runtime/arrays/sections.hpp"
#include "runtime/arrays/typed/array_of.hpp"
#include "runtime/reduce/typed_partial.hpp"
#include "runtime/reduction.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tess {

template <class C>
class SectionProxy;

}  // namespace tess

namespace tess::detail {

/// The operation of a reduction without values.
struct AllThere {
  NoValue operator()(NoValue /*a*/, const NoValue& /*b*/) const { return {}; }
};

template <class T>
void check_target(const Element& element, const Callback<T>& target) {
  TESS_CHECK(static_cast<bool>(target), element_text(element), " contributes, but its Callback<",
             name_of_type<T>, "> for the result is empty");
}

/// The contributions of an element to its array.
struct ToArray {
  Element& element;
  Collection& collection;
  std::optional<RoundId> round;

  [[nodiscard]] Partial* open_sum(const PartialKind& kind) const {
    return round ? nullptr : collection.open_sum(element, kind);
  }
  void contributed() const { collection.contributed(element); }
  void contribute(std::unique_ptr<Partial> value) const {
    collection.contribute(element, std::move(value), round);
  }
};
/// The contributions of a member to its section.
struct ToSection {
  Element& element;
  Sections& sections;
  Sections::Seat seat;

  [[nodiscard]] Partial* open_sum(const PartialKind& kind) const {
    if (!seat.member().joined) return nullptr;
    return seat.part->reduction.open_sum(seat.member().next, kind,
                                         sections.collection().pe().context().epoch);
  }
  void contributed() const { sections.contributed(seat); }
  void contribute(std::unique_ptr<Partial> value) const {
    sections.contribute(seat, std::move(value));
  }
};

/// Merges immediately: adds to the local sum that earlier elements have started, if there is one.
template <class Key, class To, class Op, class T, class Result>
void contribute_as(const Key& /*key*/, const To& to, Op op, T value,
                   const Callback<Result>& target) {
  using Merged = MergedPartial<T, Op, Result>;
  if (Partial* open = to.open_sum(Merged::its_kind()); open != nullptr) {
    static_cast<Merged*>(open)->add(op, value, target);
    to.contributed();
  } else {
    check_target(to.element, target);
    to.contribute(std::make_unique<Merged>(std::move(op), std::move(value), target));
  }
}

/// Collects the values, which are combined in the order of keys at the end.
template <class Key, class To, class Op, class T, class Result>
void contribute_ordered(const Key& key, const To& to, Op op, T value,
                        const Callback<Result>& target) {
  static_assert(
      requires(const Key& key_) { key_ < key_; },
      "gather and in_order are in the order of indices: give the type of index an operator<=>");
  check_target(to.element, target);
  std::vector<std::pair<Key, T>> values;
  values.emplace_back(key, std::move(value));
  to.contribute(std::make_unique<OrderedPartial<T, Op, Key, Result>>(std::move(op),
                                                                     std::move(values), target));
}
template <class Key, class To, class Op, class T, class Result>
void contribute_as(const Key& key, const To& to, InOrder<Op> op, T value,
                   const Callback<Result>& target) {
  contribute_ordered(key, to, std::move(op.op), std::move(value), target);
}
template <class Key, class To, class T, class Result>
void contribute_as(const Key& key, const To& to, Gather op, T value,
                   const Callback<Result>& target) {
  contribute_ordered(key, to, op, std::move(value), target);
}

/// The part of a chare's or group member's base class that contributes. The target is passed by
/// reference: all contributions but the first only compare it.
template <class Index>
class TessContributor : public TessIndexedElement<Index> {
 protected:
  /// Contributes a value; a constructor's contribution waits until the element is listed.
  template <class Op, class T>
  void contribute(Op op, T value, const Callback<T>& target) {
    tess_give(std::move(op), std::move(value), target);
  }
  /// The same, with an operation whose result is of another type.
  template <class Op, class T, class U>
    requires(!std::is_same_v<T, U>)
  void contribute(Op op, T value, const Callback<U>& target) {
    tess_give(std::move(op), std::move(value), target);
  }
  /// Contributes to a reduction without values: the target learns that all elements are there.
  void contribute(const Callback<void>& target) {
    contribute(AllThere{}, NoValue{}, target.of_no_value());
  }

  /// Gives the value to the round of this number.
  template <class Op, class T, class U>
  void contribute(RoundId round, Op op, T value, const Callback<U>& target) {
    tess_give(std::move(op), std::move(value), target, round);
  }
  void contribute(RoundId round, const Callback<void>& target) {
    contribute(round, AllThere{}, NoValue{}, target.of_no_value());
  }

  /// The same to reductions over the members of a section.
  template <class C, class Op, class T>
  void contribute(const SectionProxy<C>& section, Op op, T value, const Callback<T>& target) {
    tess_give_to(section, std::move(op), std::move(value), target);
  }
  template <class C, class Op, class T, class U>
    requires(!std::is_same_v<T, U>)
  void contribute(const SectionProxy<C>& section, Op op, T value, const Callback<U>& target) {
    tess_give_to(section, std::move(op), std::move(value), target);
  }
  template <class C>
  void contribute(const SectionProxy<C>& section, const Callback<void>& target) {
    contribute(section, AllThere{}, NoValue{}, target.of_no_value());
  }

 private:
  template <class Op, class T, class U>
  void tess_give(Op op, T value, const Callback<U>& target, std::optional<RoundId> round = {}) {
    if constexpr (tess_fits<Op, T, U>()) {
      if (this->collection_ == nullptr) [[unlikely]] {
        const auto held = std::make_shared<std::pair<T, Callback<U>>>(std::move(value), target);
        Element::after_construction("contribute()", [this, op, held, round] {
          tess_give(op, std::move(held->first), held->second, round);
        });
        return;
      }
      contribute_as(this->index_, ToArray{*this, *this->collection_, round}, std::move(op),
                    std::move(value), target);
    }
  }
  template <class C, class Op, class T, class U>
  void tess_give_to(const SectionProxy<C>& section, Op op, T value, const Callback<U>& target) {
    static_assert(std::is_base_of_v<TessContributor, C>,
                  "the section is of an array with another type of index");
    if constexpr (tess_fits<Op, T, U>()) {
      if (this->collection_ == nullptr) [[unlikely]] {
        const auto held = std::make_shared<std::pair<T, Callback<U>>>(std::move(value), target);
        Element::after_construction("contribute()", [this, section, op, held] {
          tess_give_to(section, op, std::move(held->first), held->second);
        });
        return;
      }
      TESS_CHECK(section.array_ == this->collection_->id(), element_text(*this),
                 " contributes to a section of another array");
      Sections& sections = this->collection_->sections();
      const ToSection to{*this, sections, sections.contributor(*this, section.id_)};
      if (to.seat.part == nullptr) return;  // the section has ended
      contribute_as(this->index_, to, std::move(op), std::move(value), target);
    }
  }
  template <class Op, class T, class U>
  static consteval bool tess_fits() {
    constexpr bool same = std::is_same_v<typename ResultOf<Op, T, Index>::type, U>;
    static_assert(same, "the value has another type than the target's: Callback<T>");
    return same;
  }
};

}  // namespace tess::detail
