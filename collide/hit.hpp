// The ids of the objects of a collision, and the rules for its pairs. An Item is a box with the id of
// the object that it bounds: plain bytes without padding, so messages and hashes of it are exact.
// The collision uses only the model of an id; owner and number are opaque to it.
#pragma once

#include "collide/box.hpp"

#include <compare>
#include <cstdint>
#include <span>
#include <type_traits>

namespace tess::collide {

/// The owner of an object, which receives its hits: for example an element of an array.
enum class OwnerId : std::uint64_t {};
/// The number of an object at its owner.
enum class LocalId : std::uint32_t {};
/// The model that an object belongs to. Pairs within a model can be left out.
enum class ModelId : std::uint32_t {};

/// The id of an object. Ids must be unique within a collision.
struct ObjectId {
  OwnerId owner{};
  LocalId local{};
  ModelId model{};

  friend auto operator<=>(const ObjectId&, const ObjectId&) = default;
};

/// An object of the broad phase: one cache line, sent to each voxel that its box touches.
struct Item {
  Aabb box;
  ObjectId id;
};

static_assert(std::is_trivially_copyable_v<Item> && sizeof(Item) == 64);
static_assert(std::has_unique_object_representations_v<ObjectId>);

/// Whether pairs within one model are tested: everywhere, unless a caller says `skip`.
enum class WithinModel { skip, test };

/// Decides which pairs are hits.
struct PairRules {
  Touching touching = Touching::counts;
  WithinModel within_model = WithinModel::test;
};

/// What becomes of an object whose box is not valid: all that was given with it is refused by an
/// Error that names it, or it alone is left out, and counted.
enum class InvalidBoxes { refuse, leave_out };

/// Throws Error (bad_value) with the first item whose box is not valid.
void check_boxes(std::span<const Item> items);

}  // namespace tess::collide
