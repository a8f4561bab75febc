// Scans: each element of an array contributes a value, and gets the values of all elements of lower
// index combined. Not part of runtime.hpp.
//
// Sample: tests/samples/scan.cpp
//
//     tess::Future<std::int64_t> first;
//     contribute(tess::exclusive_scan(tess::sum, std::int64_t{0}), n_points_, first.callback());
//     first_ = co_await first;
//
// A scan is a reduction in which each element names a target of its own: a future, or an entry
// method (self().target<&C::f>()). It is numbered and has members as other reductions have
// (Chare::contribute()), so several may be under way: the k-th contributions of all elements belong
// together. Elements may migrate at any time; a group's members are ordered by PE.
//
// A PE keeps the contributions of its elements, and sends up the tree one value for each run of
// indices that nothing can stand between: those that differ by one on the last axis. The root
// combines the runs in the order of indices and answers to the PEs that hold them:
//
//     PE 0: [0] 3  [1] 1        run [0]… 4          ──►  root  ──►  nothing before  ──►  3, 4
//     PE 1: [2] 5  [3] 2  [7] 1 runs [2]… 7, [7] 1  ──►        ──►  4, 17           ──►  9, 11; 18
//     PE 2: [4] 6  [5] 0  [6] 0 run [4]… 6          ──►        ──►  11              ──►  17, 17, 17
//
// So an array in blocks costs the root one value per PE, and one that is scattered a value per
// element, as tess::gather does. The epoch of a contribution waits for its result.
#pragma once

#include "runtime/arrays/typed/scan_partial.hpp"
#include "runtime/wire/messages/entry_traits.hpp"

#include <optional>
#include <type_traits>
#include <utility>

namespace tess {

/// Each element gets the combination of the values up to its own.
template <class Op>
struct InclusiveScan {
  [[no_unique_address]] Op op;
};
/// Each element gets `first` combined with the values before its own.
template <class Op, class T>
struct ExclusiveScan {
  [[no_unique_address]] Op op;
  T first;
};
/// The operation combines two values and is associative; it need not be commutative. in_order(op)
/// combines the values one after the other, so that a floating-point result does not depend on the
/// placement of the elements; the root then gets a value per element.
template <class Op>
[[nodiscard]] constexpr InclusiveScan<Op> inclusive_scan(Op op) {
  return {std::move(op)};
}
template <class Op, class T>
[[nodiscard]] constexpr ExclusiveScan<Op, T> exclusive_scan(Op op, T first) {
  return {std::move(op), std::move(first)};
}

namespace detail {

template <class Op>
inline constexpr bool is_scan = false;
template <class Op>
inline constexpr bool is_scan<InclusiveScan<Op>> = true;
template <class Op, class T>
inline constexpr bool is_scan<ExclusiveScan<Op, T>> = true;

template <class Op, class T, class Key>
struct ResultOf<InclusiveScan<Op>, T, Key> : ResultOf<Op, T, Key> {};
template <class Op, class First, class T, class Key>
struct ResultOf<ExclusiveScan<Op, First>, T, Key> : ResultOf<Op, T, Key> {};

template <class Key, class Op, class T, class Result>
void contribute_as(const Key& key, const ToArray& to, InclusiveScan<Op> scan, T value,
                   const Callback<Result>& target) {
  contribute_to_scan(key, to, scan.op, std::move(value), std::optional<T>(), target);
}
template <class Key, class Op, class First, class T, class Result>
void contribute_as(const Key& key, const ToArray& to, ExclusiveScan<Op, First> scan, T value,
                   const Callback<Result>& target) {
  static_assert(std::is_convertible_v<First, T> && !loses_digits<T, First>,
                "the first value of an exclusive scan has another type than the contributions");
  contribute_to_scan(key, to, scan.op, std::move(value),
                     std::optional<T>(static_cast<T>(std::move(scan.first))), target);
}
template <class Key, class Scan, class T, class Result>
  requires is_scan<Scan>
void contribute_as(const Key& /*key*/, const ToSection& /*to*/, Scan /*scan*/, T /*value*/,
                   const Callback<Result>& /*target*/) {
  static_assert(!is_scan<Scan>, "a scan is over the elements of a whole array, not of a section");
}

}  // namespace detail

}  // namespace tess
