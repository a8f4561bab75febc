// What a PE asks of a collection of elements that it hosts: a name for reports, and what waits there.
// Collection (collections/collection.hpp) implements it.
#pragma once

#include "runtime/core/ids.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tess {

class Element;

class HostedCollection {
 public:
  HostedCollection(const HostedCollection&) = delete;
  HostedCollection& operator=(const HostedCollection&) = delete;
  virtual ~HostedCollection() = default;

  [[nodiscard]] CollectionId id() const { return id_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Elements on this PE.
  [[nodiscard]] std::size_t n_local() const { return n_local_; }
  /// A broadcast has reached it: a reduction of its elements may be awaited.
  [[nodiscard]] virtual bool was_called() const = 0;
  /// "Block[3,4]" of the index that Pe::constructed_index() points to.
  [[nodiscard]] virtual std::string constructed_text(const void* index) const = 0;
  /// Appends a line for each thing here that waits for something that never came.
  virtual void describe_waiting(std::vector<std::string>& lines) const = 0;

 protected:
  HostedCollection(CollectionId id, std::string name) : id_(id), name_(std::move(name)) {}

  std::size_t n_local_ = 0;

 private:
  const CollectionId id_;
  const std::string name_;
};

/// "Block[3,4]" of an element; the layer that has elements gives it to the runtime.
using ElementText = std::string (*)(const Element& element);

}  // namespace tess
