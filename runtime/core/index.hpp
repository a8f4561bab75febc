// The index of an array's element: a tuple of one to six coordinates, or any type that compares
// equal, packs and hashes, such as a string or a struct of the user. A Range is the dense box [0,
// extent) of such tuples.
#pragma once

#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/ids.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/core/text.hpp"

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace tess {

struct Index1 {
  std::int32_t x = 0;
  friend auto operator<=>(const Index1&, const Index1&) = default;
};
struct Index2 {
  std::int32_t x = 0, y = 0;
  friend auto operator<=>(const Index2&, const Index2&) = default;
};
struct Index3 {
  std::int32_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const Index3&, const Index3&) = default;
};
struct Index4 {
  std::int32_t x = 0, y = 0, z = 0, w = 0;
  friend auto operator<=>(const Index4&, const Index4&) = default;
};
struct Index5 {
  std::array<std::int32_t, 5> x{};
  friend auto operator<=>(const Index5&, const Index5&) = default;
};
struct Index6 {
  std::array<std::int32_t, 6> x{};
  friend auto operator<=>(const Index6&, const Index6&) = default;
};

namespace detail {
template <class T>
struct IsCoordinates : std::false_type {};
template <std::size_t n>
struct IsCoordinates<std::array<std::int32_t, n>> : std::true_type {};

/// An index of one axis less.
template <std::int32_t n_axes>
struct FewerAxes {};
template <>
struct FewerAxes<3> : std::type_identity<Index2> {};
template <>
struct FewerAxes<4> : std::type_identity<Index3> {};
template <>
struct FewerAxes<5> : std::type_identity<Index4> {};
template <>
struct FewerAxes<6> : std::type_identity<Index5> {};
/// A list of more numbers than an index of n_axes has.
template <std::int32_t n_axes>
struct MoreAxes {
  template <std::integral... X>
    requires(sizeof...(X) > static_cast<std::size_t>(n_axes))
  MoreAxes(X... /*x*/) {}  // NOLINT(google-explicit-constructor): it stands for the list
};
}  // namespace detail

/// Coordinates of an index that a Range can enumerate: one to six numbers, of which x is the first
/// or all of them.
template <class Index>
concept Coordinates =
    Bitwise<Index> && sizeof(Index) % 4 == 0 && sizeof(Index) <= 24 && requires(Index i) {
      requires(std::same_as<decltype(i.x), std::int32_t> ||
               detail::IsCoordinates<decltype(i.x)>::value);
    };

template <Coordinates Index>
inline constexpr std::int32_t n_axes_of = static_cast<std::int32_t>(sizeof(Index) / 4);

namespace detail {
/// A coordinate from an integer of any type.
template <std::integral X>
[[nodiscard]] std::int32_t axis_of(X x) {
  TESS_CHECK(std::in_range<std::int32_t>(x), "an index is ", x, ", but a coordinate has 32 bits");
  return static_cast<std::int32_t>(x);
}
}  // namespace detail

/// The hash of an index. It is the same in every process, since homes are computed from it. Indices
/// that are equal have equal bytes: without a -0.0, or an unordered container.
template <class Index>
struct IndexHash {
  using is_avalanching = void;
  std::size_t operator()(const Index& index) const noexcept {
    if constexpr (Bitwise<Index> && sizeof(Index) <= 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, &index, sizeof index);
      return mix(word);
    } else if constexpr (Bitwise<Index>) {
      return hash_bytes(&index, sizeof index);
    } else if constexpr (std::is_convertible_v<const Index&, std::string_view>) {
      const std::string_view view = index;
      return hash_bytes(view.data(), view.size());
    } else {
      const auto bytes = to_bytes(index);
      return hash_bytes(bytes.data(), bytes.size());
    }
  }
};

/// An index as text for reports: [3], [1,2,3], ["name"], or its hash. An enum is its number.
template <class Index>
[[nodiscard, gnu::cold]] std::string index_text(const Index& index) {
  if constexpr (std::is_convertible_v<const Index&, std::string_view>) {
    return text("[\"", std::string_view(index), "\"]");
  } else if constexpr (Writable<Index>) {
    return text("[", index, "]");
  } else if constexpr (std::is_enum_v<Index>) {
    return text("[", static_cast<std::int64_t>(index), "]");
  } else if constexpr (std::is_aggregate_v<Index>) {
    std::string out = "[";
    const auto add = [&out](const auto& field) {
      if (out.size() > 1) out += ",";
      if constexpr (Writable<std::remove_cvref_t<decltype(field)>>) {
        out += text(field);
      } else if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(field)>>) {
        out += text(static_cast<std::int64_t>(field));
      } else if constexpr (requires { field.begin(); }) {
        for (bool first = true; const auto& item : field) {
          if (!std::exchange(first, false)) out += ",";
          out += text(item);
        }
      } else {
        out += "?";
      }
    };
    detail::for_each_field(index, add);
    return out + "]";
  } else {
    return text("[#", IndexHash<Index>()(index), "]");
  }
}

/// The dense box of indices 0 … extent − 1 on each axis. `n_axes` 0 is the empty range of a sparse
/// array.
struct Range {
  constexpr Range() = default;  // no aggregate: create<C>({2, 2}) does not compile

  std::array<std::int32_t, 6> extent{1, 1, 1, 1, 1, 1};
  std::int32_t n_axes = 0;

  [[nodiscard]] std::uint64_t size() const {
    if (n_axes == 0) return 0;
    std::uint64_t n = 1;
    for (const std::int32_t e : extent) n *= static_cast<std::uint64_t>(e);
    return n;
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(extent, n_axes);
  }
};

/// The homes of a dense range: equal blocks of ranks over the PEs. The division by the block size
/// is a multiplication by its inverse where that is exact.
class BlockMap {
 public:
  BlockMap(const Range& range, std::int32_t n_pes)
      : size_(range.size()), n_pes_(static_cast<std::uint64_t>(n_pes)) {
    constexpr std::uint64_t most = std::uint64_t{1} << 32U;
    if (size_ > 1 && size_ < most / n_pes_) inverse_ = ~std::uint64_t{0} / size_ + 1;
  }
  [[nodiscard]] PeId home(std::int64_t rank) const {
    __extension__ using Wide = unsigned __int128;
    const std::uint64_t scaled = static_cast<std::uint64_t>(rank) * n_pes_;
    const std::uint64_t pe =
        inverse_ != 0 ? static_cast<std::uint64_t>(Wide{scaled} * inverse_ >> 64U) : scaled / size_;
    return PeId{static_cast<std::int32_t>(pe)};
  }

 private:
  std::uint64_t size_, n_pes_;
  std::uint64_t inverse_ = 0;  // 2^64 divided by the block size, rounded up
};

/// A dense range of one to six axes. Throws Error for a negative extent, and for more than 2^40
/// elements.
template <class... Extent>
[[nodiscard]] Range range(Extent... extents) {
  static_assert(sizeof...(Extent) >= 1 && sizeof...(Extent) <= 6, "a range has one to six axes");
  static_assert((std::is_integral_v<Extent> && ...), "the extents of a range are integers");
  Range out;
  for (const auto extent : {static_cast<std::int64_t>(extents)...}) {
    if (extent < 0 || extent > 0x7fffffff)
      fail(ErrorCode::bad_argument, "range: extent ", extent, " is not within 0 … 2147483647");
    out.extent[static_cast<std::size_t>(out.n_axes++)] = static_cast<std::int32_t>(extent);
  }
  double n = 1;
  for (const std::int32_t extent : out.extent) n *= extent;
  if (n > 0x1p40)
    fail(ErrorCode::bad_argument, "range: ", n,
         " elements; at most 2^40 are in a range: give tess::sparse, and insert those that exist");
  return out;
}

/// The range of a sparse array: it has no elements at first; all are inserted or created on demand.
struct Sparse {
  constexpr operator Range() const { return {}; }  // NOLINT(google-explicit-constructor)
};
inline constexpr Sparse sparse{};

/// The rank of an index within a range in row-major order, or −1 outside.
template <Coordinates Index>
[[nodiscard]] std::int64_t rank_in(const Range& range, const Index& index) {
  if (range.n_axes != n_axes_of<Index>) return -1;
  const auto at = std::bit_cast<std::array<std::int32_t, sizeof(Index) / 4>>(index);
  std::int64_t rank = 0;
  for (std::size_t axis = 0; axis < at.size(); ++axis) {
    if (at[axis] < 0 || at[axis] >= range.extent[axis]) return -1;
    rank = rank * range.extent[axis] + at[axis];
  }
  return rank;
}

/// The index of a rank; the inverse of rank_in.
template <Coordinates Index>
[[nodiscard]] Index index_at(const Range& range, std::int64_t rank) {
  std::array<std::int32_t, sizeof(Index) / 4> at{};
  for (std::size_t axis = at.size(); axis-- > 0;) {
    at[axis] = static_cast<std::int32_t>(rank % range.extent[axis]);
    rank /= range.extent[axis];
  }
  Index index;
  std::memcpy(static_cast<void*>(&index), at.data(), sizeof index);
  return index;
}

}  // namespace tess
