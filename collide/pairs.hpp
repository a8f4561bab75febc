// All pairs of objects that intersect, in one thread and without the runtime. The same words serve
// boxes, shapes and types of the user; collider.hpp does it on chares.
//
// Sample: tests/samples/pairs.cpp
//
//     const std::vector<Pair> all = pairs(std::span<const Aabb>(boxes));
//     PairStatistics report;
//     const std::uint64_t n = count_pairs(planes, rockets, {.statistics = &report});
//
// An object is a Box<float or double, 2 to 4>, or any type with two functions that are found beside
// it:
//
//     Box<Real, D> box_of(const Object&);                          contains the object
//     bool intersect(const Object&, const Object&, Touching);      decides a pair whose boxes overlap
//
// A type in three dimensions may have a third one. If the objects of a search are long and thin, so
// that their boxes are mostly empty, it spares most of the exact tests. Objects whose capsules have
// no common point must not intersect:
//
//     Capsule capsule_of(const Object&);                           contains the object
//
// Every pair is reported once, in no particular order. The voxels that the objects are sorted into
// have no influence on the answer (Lawlor and Kalé 2002).
#pragma once

#include "collide/capsule.hpp"
#include "collide/grid_counts.hpp"
#include "collide/hit.hpp"
#include "runtime/core/algorithm.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace tess::collide {

/// The positions of two objects. Within one set, first < second; otherwise `first` is a position in
/// the first set and `second` one in the second.
struct Pair {
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  friend auto operator<=>(const Pair&, const Pair&) = default;
};

/// How the pairs of one voxel are found. `automatic` chooses by measured costs; all of them find
/// the same pairs. `bisection` is the paper's recursive coordinate bisection.
enum class PairMethod { automatic, all_pairs, sweep, bisection };

/// What a search did.
struct PairStatistics {
  GridCounts grid;
  /// Pairs whose boxes overlap. If long thin objects are searched in pieces, these are pairs of
  /// pieces.
  std::uint64_t n_candidates = 0;
  std::uint64_t n_pairs = 0;    ///< pairs that intersect
  std::uint64_t n_invalid = 0;  ///< objects that were left out (PairOptions::invalid_boxes)
  std::size_t bytes = 0;        ///< memory beside the objects
};

struct PairOptions {
  Touching touching = Touching::counts;
  /// One model per object, for searches within one set only; needed to skip pairs within a model.
  std::span<const std::uint32_t> models = {};
  WithinModel within_model = WithinModel::test;
  double voxel_size = 0;  ///< positive and finite; or 0: chosen by expected cost
  PairMethod method = PairMethod::automatic;
  PairStatistics* statistics = nullptr;               ///< is filled
  InvalidBoxes invalid_boxes = InvalidBoxes::refuse;  ///< left out: capsules are not asked then
};

namespace detail {

/// Receives n pairs (objects[p], partners[p]). With two sets and `swapped`, the objects are of the
/// second.
struct PairSink {
  void* context;
  void (*call)(void* context, const std::uint32_t* objects, const std::uint32_t* partners,
               std::size_t n, bool swapped);
};

/// The capsules of the objects of a set, or none.
struct Capsules {
  const void* objects = nullptr;
  Capsule (*of)(const void* objects, std::size_t i) = nullptr;

  [[nodiscard]] Capsule operator[](std::size_t i) const { return checked(of(objects, i)); }
};

/// Whether most of n objects are much longer than thick, as far as a few of them show.
[[nodiscard]] bool seem_thin(const Capsules& capsules, std::size_t n);

/// A set of objects that is searched.
template <class TheBox>
struct ObjectSet {
  std::span<const TheBox> boxes;
  Capsules capsules{};  ///< in three dimensions only
};

/// Passes on the pairs within one set, or those across two sets. If all objects have capsules, a
/// pair of long thin ones is passed on only if their capsules may have a common point, and never
/// twice.
template <class TheBox>
void search_pairs(std::span<const ObjectSet<TheBox>> sets, const PairOptions& options,
                  PairSink sink);

template <class T>
inline constexpr bool is_box = false;
template <class Real, std::size_t D>
inline constexpr bool is_box<Box<Real, D>> = true;

template <class Object>
using BoxOf = std::remove_cvref_t<decltype(box_of(std::declval<const Object&>()))>;

template <class Object>
concept HasBox = requires(const Object& object) { box_of(object).lo.size(); };
template <class A, class B>
concept CanIntersect = requires(const A& a, const B& b) {
  { intersect(a, b, Touching::counts) } -> std::convertible_to<bool>;
};

/// The exact test of two objects whose boxes overlap; of two boxes there is none.
template <class A, class B>
[[nodiscard]] bool objects_intersect(const A& a, const B& b, Touching touching) {
  static_assert((is_box<A> && is_box<B>) || CanIntersect<A, B>,
                "pairs of objects that are no boxes need bool intersect(const A&, const B&, "
                "Touching) beside their type");
  if constexpr (is_box<A> && is_box<B>)
    return true;
  else if constexpr (CanIntersect<A, B>)
    return intersect(a, b, touching);
}

/// The boxes of objects that are no boxes.
template <class Object>
auto boxes_of(std::span<const Object> objects) {
  static_assert(
      is_box<Object> || HasBox<Object>,
      "objects that are searched need Box<Real, D> box_of(const Object&) beside their type");
  if constexpr (is_box<Object>) {
    return objects;
  } else {
    std::vector<BoxOf<Object>> boxes;
    boxes.reserve(objects.size());
    for (const Object& object : objects) boxes.push_back(box_of(object));
    return boxes;
  }
}

template <class Object>
concept HasCapsule = requires(const Object& object) {
  { capsule_of(object) } -> std::same_as<Capsule>;
} && std::tuple_size_v<decltype(BoxOf<Object>::lo)> == 3;

template <HasCapsule Object>
Capsules capsules_of(std::span<const Object> objects) {
  return {objects.data(), [](const void* of, std::size_t i) {
            return capsule_of(static_cast<const Object*>(of)[i]);
          }};
}

/// The boxes are those of boxes_of().
template <class Object>
ObjectSet<BoxOf<Object>> set_of(std::span<const Object> objects,
                                std::span<const BoxOf<Object>> boxes) {
  if constexpr (HasCapsule<Object>)
    return {boxes, capsules_of(objects)};
  else
    return {boxes};
}

}  // namespace detail

/// What a client submits with the boxes of its objects (Objects in collider.hpp): the capsules, or
/// none if the objects are so short or thick that they would not pay.
template <detail::HasCapsule Object>
[[nodiscard]] std::vector<Capsule> thin_capsules_of(std::span<const Object> objects) {
  std::vector<Capsule> out;
  if (!detail::seem_thin(detail::capsules_of(objects), objects.size())) return out;
  out.reserve(objects.size());
  for (const Object& object : objects) out.push_back(capsule_of(object));
  return out;
}

namespace detail {

/// A sink that calls found(i, j) per pair for which test(i, j) holds; i is of the first set.
template <class Test, class Found>
struct TestedPairs {
  const Test& test;
  Found& found;
  std::uint64_t n = 0;

  static void call(void* context, const std::uint32_t* objects, const std::uint32_t* partners,
                   std::size_t n_pairs, bool swapped) {
    auto& self = *static_cast<TestedPairs*>(context);
    const std::uint32_t* const first = swapped ? partners : objects;
    const std::uint32_t* const second = swapped ? objects : partners;
    std::uint64_t n = 0;
    for (std::size_t p = 0; p < n_pairs; ++p) {
      if (!self.test(first[p], second[p])) continue;
      ++n;
      self.found(first[p], second[p]);
    }
    self.n += n;
  }
};

template <class Test, class Found, class Search>
void for_each_tested(const PairOptions& options, const Test& test, Found& found,
                     const Search& search) {
  TestedPairs<Test, Found> pairs{test, found};
  search(PairSink{&pairs, &TestedPairs<Test, Found>::call});
  if (options.statistics != nullptr) options.statistics->n_pairs = pairs.n;
}

}  // namespace detail

/// The filter of searches that have none; it costs nothing.
struct EveryPair {
  constexpr bool operator()(std::uint32_t, std::uint32_t) const noexcept { return true; }
};

/// Calls found(i, j) once per pair of objects that intersect, with i < j. With a filter, only pairs
/// count for which wanted(i, j) is true; it is asked before the exact test, once per pair of boxes
/// that overlap (of objects with capsules at most once: not if the capsules are apart). Throws
/// Error (bad_value) before the first call, with the position of an object whose box is not valid,
/// or if the voxel size is no size or too small for the memory.
template <class Object, class Found, class Wanted = EveryPair>
void for_each_pair(std::span<const Object> objects, const PairOptions& options, Found&& found,
                   const Wanted& wanted = {}) {
  const auto boxes = detail::boxes_of(objects);
  // Without a branch, which would be mispredicted for every second pair.
  auto ordered = [&](std::uint32_t i, std::uint32_t j) { found(std::min(i, j), std::max(i, j)); };
  const auto test = [&](std::uint32_t i, std::uint32_t j) {
    return wanted(std::min(i, j), std::max(i, j)) &&
           detail::objects_intersect(objects[i], objects[j], options.touching);
  };
  detail::for_each_tested(options, test, ordered, [&](detail::PairSink sink) {
    const auto set = detail::set_of(objects, boxes);
    detail::search_pairs<detail::BoxOf<Object>>({&set, 1}, options, sink);
  });
}

/// The same, for pairs of an object `i` of the first set and an object `j` of the second.
template <class A, class B, class Found, class Wanted = EveryPair>
void for_each_pair(std::span<const A> a, std::span<const B> b, const PairOptions& options,
                   Found&& found, const Wanted& wanted = {}) {
  static_assert(std::is_same_v<detail::BoxOf<A>, detail::BoxOf<B>>,
                "the boxes of the two sets have different types");
  const auto boxes_a = detail::boxes_of(a);
  const auto boxes_b = detail::boxes_of(b);
  const auto test = [&](std::uint32_t i, std::uint32_t j) {
    return wanted(i, j) && detail::objects_intersect(a[i], b[j], options.touching);
  };
  detail::for_each_tested(options, test, found, [&](detail::PairSink sink) {
    const std::array sets{detail::set_of(a, boxes_a), detail::set_of(b, boxes_b)};
    detail::search_pairs<detail::BoxOf<A>>(sets, options, sink);
  });
}

/// The pairs as a list.
template <class Object, class Wanted = EveryPair>
[[nodiscard]] std::vector<Pair> pairs(std::span<const Object> objects,
                                      const PairOptions& options = {}, const Wanted& wanted = {}) {
  std::vector<Pair> out;
  for_each_pair(
      objects, options,
      [&](std::uint32_t i, std::uint32_t j) {
        out.push_back({i, j});
      },
      wanted);
  return out;
}
template <class A, class B, class Wanted = EveryPair>
[[nodiscard]] std::vector<Pair> pairs(std::span<const A> a, std::span<const B> b,
                                      const PairOptions& options = {}, const Wanted& wanted = {}) {
  std::vector<Pair> out;
  for_each_pair(
      a, b, options,
      [&](std::uint32_t i, std::uint32_t j) {
        out.push_back({i, j});
      },
      wanted);
  return out;
}

/// The number of pairs.
template <class Object, class Wanted = EveryPair>
[[nodiscard]] std::uint64_t count_pairs(std::span<const Object> objects,
                                        const PairOptions& options = {},
                                        const Wanted& wanted = {}) {
  std::uint64_t n = 0;
  for_each_pair(
      objects, options, [&](std::uint32_t, std::uint32_t) { ++n; }, wanted);
  return n;
}
template <class A, class B, class Wanted = EveryPair>
[[nodiscard]] std::uint64_t count_pairs(std::span<const A> a, std::span<const B> b,
                                        const PairOptions& options = {},
                                        const Wanted& wanted = {}) {
  std::uint64_t n = 0;
  for_each_pair(
      a, b, options, [&](std::uint32_t, std::uint32_t) { ++n; }, wanted);
  return n;
}

}  // namespace tess::collide
