// Objects of several clients in one list: the boxes, and per object a number of four bytes for its
// client and model, and one for its number there. Lists of a single client have neither. Long thin
// objects may be in pieces, each with a box of its own. A list that is cleared keeps its memory.
#pragma once

#include "collide/capsule.hpp"
#include "collide/hit.hpp"
#include "collide/objects.hpp"
#include "collide/parallel/piece_table.hpp"
#include "collide/problem/entry.hpp"
#include "collide/problem/octaves.hpp"
#include "collide/problem/scratch.hpp"
#include "runtime/core/algorithm.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/ids.hpp"
#include "runtime/core/serialize.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace tess::collide {

class ObjectList {
 public:
  /// Objects that are submitted on a PE. Both throw Error (bad_value) with the object if a box is
  /// not valid, or with the numbers if objects are more than 2^28, or capsules neither none nor one
  /// per object; then they change nothing.
  void append(const Objects& objects, PeId pe);
  void append(std::span<const Item> items, std::span<const Capsule> capsules, PeId pe);
  /// Objects of another list. Adds their entries in this list to `copies`. They are not counted in
  /// bounds() and has_octave().
  void append(const ObjectList& from, std::span<const search::Entry> entries,
              std::vector<search::Entry>& copies);
  /// Divides the objects of this PE into pieces that are at most `longest` long on each axis, if no
  /// more than 64 are needed for that: the list has a box for each piece then. All lists of a
  /// collision are divided, or none.
  void divide(const search::Frame& frame, double longest, PeId pe);
  /// Makes room for objects of other lists.
  void reserve(std::size_t n) {
    boxes_.reserve(n);
    local_.reserve(n);
  }
  void clear();
  /// Sets each box to change(box). bounds() and has_octave() remain those of the boxes before.
  template <class Change>
  void change_boxes(const Change& change) {
    for (std::size_t i = 0; i < boxes_.size(); ++i) boxes_.data()[i] = change(boxes_.data()[i]);
  }
  /// True if both have the same objects at the same positions, whatever their boxes.
  [[nodiscard]] bool has_objects_of(const ObjectList& other) const {
    return size() == other.size() && sources_ == other.sources_ && source_of_ == other.source_of_ &&
           local_ == other.local_;
  }

  [[nodiscard]] std::uint32_t size() const noexcept {
    return static_cast<std::uint32_t>(boxes_.size());
  }
  [[nodiscard]] std::span<const Aabb> boxes() const noexcept {
    return {boxes_.data(), boxes_.size()};
  }
  [[nodiscard]] const Aabb& bounds() const noexcept { return bounds_; }
  /// True if the longest extent of an object has this octave.
  [[nodiscard]] bool has_octave(std::size_t octave) const noexcept { return octaves_[octave] != 0; }

  /// Where objects come from.
  struct Source {
    OwnerId owner{};
    ModelId model{};
    PeId pe{};                // where they were submitted
    std::uint32_t shift = 0;  // the number of an object is its position plus this, modulo 2^32
    friend bool operator==(const Source&, const Source&) = default;
  };
  [[nodiscard]] std::span<const Source> sources() const noexcept { return sources_; }
  /// The position of an object's source in sources().
  [[nodiscard]] std::uint32_t source(std::uint32_t object) const noexcept {
    return source_of_.empty() ? 0 : source_of_[object];
  }
  [[nodiscard]] ModelId model(std::uint32_t object) const noexcept {
    return sources_[source(object)].model;
  }
  /// The number of an object of sources()[source].
  [[nodiscard]] LocalId local(std::uint32_t object, std::uint32_t source) const noexcept {
    return static_cast<LocalId>(local_.empty() ? object + sources_[source].shift : local_[object]);
  }
  [[nodiscard]] bool has_capsules() const noexcept { return !capsules_.empty(); }
  [[nodiscard]] const Capsule& capsule(std::uint32_t object) const noexcept {
    return capsules_.empty() ? unknown_capsule : capsules_[object];
  }
  /// Of which objects the boxes are pieces; empty in a list that is not divided.
  [[nodiscard]] const PieceTable& pieces() const noexcept { return pieces_; }
  /// True if all objects have one model.
  [[nodiscard]] bool has_one_model() const noexcept { return !several_models_; }

  /// If `keeper` keeps this list, the boxes may be attached to a message.
  template <class Ar>
  void serialize(Ar& ar, const std::shared_ptr<const void>& keeper) {
    ar(several_models_, sources_, source_of_, local_, pieces_);
    if constexpr (Ar::is_reading) {
      ar.template numbers<Aabb>([this](std::size_t n) {
        boxes_.resize(n);
        return boxes_.data();
      });
    } else {
      ar.numbers(boxes(), keeper);
    }
  }

 private:
  /// Sources that differ in nothing but their shifts are the same to these.
  struct HashOrigin {
    std::size_t operator()(const Source& s) const noexcept {
      const std::uint64_t place = std::uint64_t{static_cast<std::uint32_t>(s.pe.value)} << 32;
      return mix(static_cast<std::uint64_t>(s.owner) ^
                 mix(place | static_cast<std::uint32_t>(s.model)));
    }
  };
  struct SameOrigin {
    bool operator()(const Source& a, const Source& b) const noexcept {
      return a.owner == b.owner && a.model == b.model && a.pe == b.pe;
    }
  };
  void check_room(std::size_t n_more, std::size_t n_capsules) const;
  /// Of the objects that have none yet.
  void add_capsules(std::span<const Capsule> capsules);
  /// Sets the numbers of the objects that have none.
  void number_objects();
  void set_sources();
  std::uint32_t find_source(Source wanted);
  void add_source(const Source& source);

  search::Scratch<Aabb> boxes_;
  std::vector<Source> sources_;
  /// The first position of each of many sources, whatever its shift; empty until it is needed.
  boost::unordered_flat_map<Source, std::uint32_t, HashOrigin, SameOrigin> places_;
  std::vector<std::uint32_t> source_of_;  // per object; empty: all 0
  std::vector<std::uint32_t> local_;      // per object; empty: by the shift of the source
  std::vector<Capsule> capsules_;         // per object that was submitted; empty: none is known
  PieceTable pieces_;
  search::Scratch<Aabb> undivided_;  // the memory is kept
  bool several_models_ = false;
  Aabb bounds_ = no_box<double, 3>();
  std::array<std::uint8_t, search::Octaves::n> octaves_{};
};

}  // namespace tess::collide
