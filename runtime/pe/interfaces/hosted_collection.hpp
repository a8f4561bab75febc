// The interface of a collection of elements that a PE hosts: its name for reports and what waits in
// it. Collection (collections/collection.hpp) implements it.
#pragma once

#include "runtime/core/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tess {
struct Range;
}

namespace tess::detail {

class TessElement;
using Element = TessElement;

class HostedCollection {
 public:
  HostedCollection(const HostedCollection&) = delete;
  HostedCollection& operator=(const HostedCollection&) = delete;
  virtual ~HostedCollection() = default;

  [[nodiscard]] CollectionId id() const { return id_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The number of elements on this PE.
  [[nodiscard]] std::size_t n_local() const { return n_local_; }
  /// First: the collection has no elements here, and was called by a broadcast, so that its
  /// reduction may be awaited. Second: a section whose root is here has no members.
  [[nodiscard]] virtual std::pair<bool, bool> has_nothing_to_reduce() const = 0;
  /// "Block[3,4]": the text for the index that Nesting::constructed_index() points to.
  [[nodiscard]] virtual std::string constructed_text(const void* index) const = 0;
  /// The indices of a dense array; of other collections it has no axes.
  [[nodiscard]] virtual const Range& range() const = 0;
  /// The elements on this PE; a slot may be null while elements leave in the middle of a broadcast.
  [[nodiscard]] virtual const std::vector<Element*>& elements() const = 0;
  /// The row-major rank of an element's index in range(); where the range has no axes the hash of
  /// the index, and in a group the number of the PE. −1: the element is not of this collection, or
  /// its index is outside of the range.
  [[nodiscard]] virtual std::int64_t rank_of(const Element& element) const = 0;
  /// Appends one line for each object here that waits for something that never arrived.
  virtual void describe_waiting(std::vector<std::string>& lines) const = 0;

 protected:
  HostedCollection(CollectionId id, std::string name) : id_(id), name_(std::move(name)) {}

  std::size_t n_local_ = 0;

 private:
  const CollectionId id_;
  const std::string name_;
};

}  // namespace tess::detail
