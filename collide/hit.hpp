// What goes into a collision and what comes out: an Item is a box with the name of the object it
// bounds, a Hit is two such names. Both are plain bytes without padding, so that messages and
// hashes of them are exact. The collision never looks into a name except to compare models.
#pragma once

#include "collide/aabb.hpp"

#include <compare>
#include <cstdint>
#include <span>
#include <type_traits>

namespace tess::collide {

/// Who owns an object and is told of its hits: a chare, a client, a file. Opaque here.
enum class OwnerId : std::uint64_t {};
/// Which of its owner's objects.
enum class LocalId : std::uint32_t {};
/// Pairs within one model are not tested, unless self-collision is asked for.
enum class ModelId : std::uint32_t {};

/// The name of an object. Names must be unique in one collision; nothing else is asked of them.
struct ObjectId {
  OwnerId owner{};
  LocalId local{};
  ModelId model{};

  friend auto operator<=>(const ObjectId&, const ObjectId&) = default;
};

/// An object as the broad phase sees it: one cache line, sent to each voxel that its box touches.
struct Item {
  Aabb box;
  ObjectId id;
};

/// Two objects whose boxes overlap; which one is first says nothing.
struct Hit {
  ObjectId first;
  ObjectId second;

  friend auto operator<=>(const Hit&, const Hit&) = default;
};

static_assert(std::is_trivially_copyable_v<Item> && sizeof(Item) == 64);
static_assert(std::is_trivially_copyable_v<Hit> && sizeof(Hit) == 32);
static_assert(std::has_unique_object_representations_v<Hit>);

/// Whether pairs within one model are tested.
enum class WithinModel { skip, test };

/// Which pairs are hits.
struct PairRules {
  Touching touching = Touching::counts;
  WithinModel within_model = WithinModel::skip;
};

/// Throws the Error that names the first item whose box has a NaN, an infinity or lo > hi.
void check_boxes(std::span<const Item> items);

}  // namespace tess::collide
