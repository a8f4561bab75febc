// Contributions of elements to reductions, for chares and for members of groups. The key orders the
// values of reductions in order: an index, or a PE.
#pragma once

#include "runtime/collections/array_of.hpp"
#include "runtime/collections/collection.hpp"
#include "runtime/collections/typed_partial.hpp"
#include "runtime/reduction.hpp"

#include <memory>
#include <utility>
#include <vector>

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

/// Merges immediately: adds to the local sum that earlier elements have started, if there is one.
template <class Key, class Op, class T>
void contribute_as(const Key& /*key*/, Element& element, Collection& collection, Op op, T value,
                   const Callback<T>& target) {
  using Merged = MergedPartial<T, Op>;
  if (Partial* open = collection.open_sum(element, Merged::its_kind()); open != nullptr) {
    static_cast<Merged*>(open)->add(op, value, target);
    collection.contributed(element);
  } else {
    check_target(element, target);
    collection.contribute(element,
                          std::make_unique<Merged>(std::move(op), std::move(value), target));
  }
}

/// Collects the values, which are combined in the order of keys at the end.
template <class Key, class Op, class T>
void contribute_as(const Key& key, Element& element, Collection& collection, InOrder<Op> op,
                   T value, const Callback<T>& target) {
  check_target(element, target);
  std::vector<std::pair<Key, T>> values;
  values.emplace_back(key, std::move(value));
  collection.contribute(element, std::make_unique<OrderedPartial<T, Op, Key>>(
                                     std::move(op.op), std::move(values), target));
}

/// The part of a chare's or group member's base class that contributes. The target is passed by
/// reference: all contributions but the first only compare it.
template <class Index>
class TessContributor : public TessIndexedElement<Index> {
 protected:
  /// Contributes a value; a constructor's contribution waits until the element is listed.
  template <class Op, class T>
  void contribute(Op op, T value, const Callback<T>& target) {
    if (this->collection_ == nullptr) [[unlikely]] {
      const auto held = std::make_shared<std::pair<T, Callback<T>>>(std::move(value), target);
      Element::after_construction("contribute()", [this, op, held] {
        contribute(op, std::move(held->first), held->second);
      });
      return;
    }
    contribute_as(this->index_, *this, *this->collection_, std::move(op), std::move(value), target);
  }
  /// Contributes to a reduction without values: the target learns that all elements are there.
  void contribute(const Callback<void>& target) {
    contribute(AllThere{}, NoValue{}, target.of_no_value());
  }
  template <class Op, class T, class U>
  void contribute(Op /*op*/, T /*value*/, const Callback<U>& /*target*/) {
    static_assert(std::is_same_v<T, U>,
                  "the value has another type than the target's: Callback<T>");
  }
};

}  // namespace tess::detail
