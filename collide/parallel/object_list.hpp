// Objects of several clients in one list: the boxes, and per object a number of four bytes for its
// client and model, and one for its number there. Lists of a single client have neither.
#pragma once

#include "collide/hit.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::collide {

/// Objects of one owner and model; the number of an object is its position.
struct Objects {
  OwnerId owner{};
  ModelId model{};
  std::vector<Aabb> boxes;
};

class ObjectList {
 public:
  /// Both throw Error (bad_value) with the object if a box is not valid, or with the number of
  /// objects if it is above 2^28, and change nothing.
  void append(Objects objects);
  void append(std::span<const Item> items);
  /// An object of another list; its box is valid.
  void append(const ObjectList& from, std::uint32_t object);

  [[nodiscard]] const std::vector<Aabb>& boxes() const noexcept { return boxes_; }
  [[nodiscard]] ObjectId id(std::uint32_t object) const noexcept {
    const Source& source = sources_[source_of_.empty() ? 0 : source_of_[object]];
    return {source.owner, static_cast<LocalId>(local_.empty() ? object : local_[object]),
            source.model};
  }
  [[nodiscard]] ModelId model(std::uint32_t object) const noexcept {
    return sources_[source_of_.empty() ? 0 : source_of_[object]].model;
  }
  /// True if all objects have one model.
  [[nodiscard]] bool has_one_model() const noexcept;

  template <class Visit>
  void for_each_model(const Visit& visit) const {
    for (const Source& source : sources_) visit(source.model);
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(boxes_, sources_, source_of_, local_);
  }

 private:
  struct Source {
    OwnerId owner{};
    ModelId model{};
    std::uint32_t unused = 0;
    friend bool operator==(const Source&, const Source&) = default;
  };
  void check_room(std::size_t n_more) const;
  /// Sets the numbers of the objects that have none.
  void number_objects();
  std::uint32_t source(OwnerId owner, ModelId model);

  std::vector<Aabb> boxes_;
  std::vector<Source> sources_;
  std::vector<std::uint32_t> source_of_;  // per object; empty: all 0
  std::vector<std::uint32_t> local_;      // per object; empty: its position
};

}  // namespace tess::collide
