// The identity of an element, independent of its array's type of index. Loads, traffic and balance
// rounds refer to elements by it.
#pragma once

#include "runtime/core/hash.hpp"
#include "runtime/core/ids.hpp"

namespace tess {

/// The array, and the hash of the index.
struct ElementKey {
  CollectionId array;
  std::uint64_t element = 0;
  friend auto operator<=>(const ElementKey&, const ElementKey&) = default;
};

struct ElementKeyHash {
  std::size_t operator()(const ElementKey& key) const noexcept {
    return mix(key.element ^ mix(key.array.value));
  }
};

}  // namespace tess
