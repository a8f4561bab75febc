// Handles: the small values by which programs name collections, their elements and sections. They
// are stored and sent, compare with ==, and are keys of unordered maps. Two that are equal name the
// same thing.
#pragma once

#include "runtime/core/ids.hpp"

#include <compare>
#include <cstddef>
#include <functional>

namespace tess::detail {

/// The std::hash of each kind of handle derives from it.
struct HashOfHandle {
  template <class Handle>
  [[nodiscard]] std::size_t operator()(const Handle& handle) const {
    return handle.hash();
  }
};

/// What a handle of a whole collection is, its number. `Self` is the class that derives from it.
template <class Self>
class WholeHandle {
 public:
  /// Of no collection: it can only be assigned to.
  WholeHandle() = default;
  explicit WholeHandle(CollectionId id) : id_(id) {}

  [[nodiscard]] CollectionId id() const { return id_; }
  [[nodiscard]] std::size_t hash() const { return std::hash<CollectionId>()(id_); }
  friend auto operator<=>(const WholeHandle&, const WholeHandle&) = default;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id_);
  }

 protected:
  CollectionId id_{};
};

}  // namespace tess::detail
