// Maps of indices to PEs: where the initial elements of an array are created, and which PE is the
// home of an index. runtime.hpp does not include this header.
//
// Sample: tests/samples/index_map.cpp
//
//     /// All cells of a column are on one PE.
//     struct ByColumn {
//       std::int32_t n_columns;
//       tess::PeId operator()(const tess::Index2& cell, std::int32_t n_pes) const {
//         return tess::PeId{cell.y * n_pes / n_columns};
//       }
//     };
//     // …
//     const auto cells = tess::create<GridCell>(tess::mapped(tess::range(4, 8), ByColumn{8}));
//
// A map is a function object whose members can be serialised, or a function: mapped<&by_column>(…).
// It is called with (index, number of PEs), or (index, range, number of PEs), on every PE and at
// any time, so it gives the same PE for the same arguments. It replaces the array's usual
// placement, and `place` of the class, for all indices: also for those outside the range, and for
// sparse arrays, whose elements send_or_create_home() creates on the home. At creation each PE
// calls it for the whole range. It goes into checkpoints; on another number of PEs it places the
// elements anew.
#pragma once

#include "runtime/array.hpp"
#include "runtime/arrays/elements/index_map.hpp"

#include <concepts>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

namespace tess {

/// Equal blocks of consecutive elements, one per PE: the usual placement of a dense array. Indices
/// outside the range are spread by their hashes.
struct InBlocks {
  template <class Index>
  PeId operator()(const Index& index, const Range& range, std::int32_t n_pes) const {
    if constexpr (Coordinates<Index>)
      if (const std::int64_t rank = rank_in(range, index); rank >= 0)
        return BlockMap(range, n_pes).home(rank);
    return detail::home_by_hash(index, n_pes);
  }
};
/// Element by element, in row-major order. An index of one axis goes on so outside the range, and
/// in a sparse array; others are spread by their hashes there.
struct RoundRobin {
  template <class Index>
  PeId operator()(const Index& index, const Range& range, std::int32_t n_pes) const {
    if constexpr (std::is_same_v<Index, Index1>) {
      const std::int32_t rest = index.x % n_pes;
      return PeId{rest < 0 ? rest + n_pes : rest};
    } else if constexpr (Coordinates<Index>) {
      if (const std::int64_t rank = rank_in(range, index); rank >= 0)
        return PeId{static_cast<std::int32_t>(rank % n_pes)};
    }
    return detail::home_by_hash(index, n_pes);
  }
};
/// A function as a map.
template <auto function>
struct MapFunction {
  template <class... Args>
    requires std::invocable<decltype(function), Args...>
  PeId operator()(Args... args) const {
    return function(args...);
  }
};
inline constexpr InBlocks block{};
inline constexpr RoundRobin round_robin{};

/// A range whose elements a map places, for create().
template <class Map>
struct Mapped {
  Range range;
  Map map;
};
template <class Map>
[[nodiscard]] Mapped<Map> mapped(const Range& range, Map map) {
  return {range, std::move(map)};
}
template <auto function>
[[nodiscard]] Mapped<MapFunction<function>> mapped(const Range& range) {
  return {range, {}};
}

namespace detail {

template <class Map, class Index>
concept MapsWithRange =
    std::is_invocable_r_v<PeId, const Map&, const Index&, const Range&, std::int32_t>;
template <class Map, class Index>
concept Maps = std::is_invocable_r_v<PeId, const Map&, const Index&, std::int32_t> ||
               MapsWithRange<Map, Index>;

template <class C, class Map>
class TypedIndexMap final : public IndexMap {
 public:
  using Index = typename C::Index;

  explicit TypedIndexMap(Map map) : map_(std::move(map)) {}

  [[nodiscard]] PeId home(const void* index, const Range& range,
                          std::int32_t n_pes) const override {
    const Index& of = *static_cast<const Index*>(index);
    PeId at;
    if constexpr (MapsWithRange<Map, Index>) {
      at = map_(of, range, n_pes);
    } else {
      at = map_(of, n_pes);
    }
    TESS_CHECK(at.value >= 0 && at.value < n_pes, "the map ", plain_name(name_of_type<Map>),
               " puts ", plain_name(name_of_type<C>), index_text(of), " on ", at,
               ", but the run has PEs 0 … ", n_pes - 1,
               ": compute the PE from the number of PEs that the map is given");
    return at;
  }
  [[nodiscard]] const IndexMapKind& kind() const override { return kind_; }
  void pack(Writer& ar) const override { ar(map_); }

 private:
  static std::shared_ptr<const IndexMap> unpack(Reader& ar) {
    return std::make_shared<TypedIndexMap>(ar.take<Map>());
  }
  static inline const IndexMapKind kind_{naming::name_of<TypedIndexMap>(), &unpack};

  [[no_unique_address]] Map map_;
};

template <class C, class Map, class... Args>
struct CreateMapped : CreateArray<C, Args...> {
  Map map;
  template <class Ar>
  void serialize(Ar& ar) {
    CreateArray<C, Args...>::serialize(ar);
    ar(map);
  }
};
template <class C, class Map, class... Args>
void create_mapped_arrives(Pe& pe, CreateMapped<C, Map, Args...>&& m, Counted /*counted*/) {
  make_array(pe, m, std::make_shared<TypedIndexMap<C, Map>>(std::move(m.map)));
}

}  // namespace detail

/// Creates an array whose elements are created on the PEs that the map gives: otherwise as create()
/// with a range.
template <class C, class Map, class... Args>
ArrayProxy<C> create(const Mapped<Map>& of, Args&&... args) {
  static_assert(!detail::OnePerPe<C>, "a group has one member on each PE: no map places them");
  static_assert(
      detail::Maps<Map, typename C::Index>,
      "a map takes an index of the array and the number of PEs, and returns a tess::PeId");
  detail::check_creation<C, Args...>(of.range);
  Pe& pe = current_pe();
  using Create = detail::CreateMapped<C, Map, std::decay_t<Args>...>;
  Create mapped{detail::new_array<C>(pe, of.range, std::forward<Args>(args)...), of.map};
  const ArrayProxy<C> proxy(mapped.id);
  detail::send_to_all<&detail::create_mapped_arrives<C, Map, std::decay_t<Args>...>>(
      pe, std::move(mapped));
  return proxy;
}

}  // namespace tess
