// Reductions combine one value of each element: contribute(tess::sum, value, target). The operation
// is one of those below or any function object that combines two values:
//
//     struct Longest {
//       std::string operator()(std::string a, std::string b) const;
//     };
//
// An operation with a finishing step has combine() and finish(), which is called once, at the root:
//
//     struct Mean {
//       struct Part { double sum; std::int64_t n; };
//       Part combine(Part a, const Part& b) const;
//       double finish(Part all) const;      // contribute(Mean{}, Part{x, 1}, Callback<double>)
//     };
//
// Its members, if it has any, travel with the values, so they are serialisable; all elements give
// the same.
// It must be associative and commutative. in_order(op) combines in the order of indices, so that a
// floating-point result does not depend on the placement of the elements.
#pragma once

#include "runtime/core/check.hpp"

#include <string_view>
#include <type_traits>
#include <utility>

namespace tess {

namespace detail {
template <class T>
concept Listable = requires(T a) {
  a.begin();
  a.size();
  a[0];
} && !std::is_convertible_v<T, std::string_view>;

/// Applies an operation to numbers, or element by element to vectors and arrays of equal length.
template <class T, class Op>
T elementwise(T a, const T& b, const Op& op) {
  if constexpr (Listable<T>) {
    TESS_CHECK(a.size() == b.size(), "a reduction over lists of ", a.size(), " and ", b.size(),
               " values");
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = elementwise(a[i], b[i], op);
    return a;
  } else {
    return op(a, b);
  }
}
template <class T>
bool is_nan(const T& x) {
  if constexpr (std::is_floating_point_v<T>) {
    return x != x;
  } else {
    return false;
  }
}
}  // namespace detail

struct Sum {
  template <class T>
  T operator()(T a, const T& b) const {
    return detail::elementwise(std::move(a), b, [](const auto& x, const auto& y) {
      return static_cast<std::decay_t<decltype(x)>>(x + y);
    });
  }
};
/// NaN if a value is NaN.
struct Min {
  template <class T>
  T operator()(T a, const T& b) const {
    return detail::elementwise(std::move(a), b, [](const auto& x, const auto& y) {
      return detail::is_nan(y) || y < x ? y : x;
    });
  }
};
/// NaN if a value is NaN.
struct Max {
  template <class T>
  T operator()(T a, const T& b) const {
    return detail::elementwise(std::move(a), b, [](const auto& x, const auto& y) {
      return detail::is_nan(y) || x < y ? y : x;
    });
  }
};
struct LogicalAnd {
  bool operator()(bool a, bool b) const { return a && b; }
};
struct LogicalOr {
  bool operator()(bool a, bool b) const { return a || b; }
};
/// Concatenates vectors or strings, in an unspecified order unless in_order() is used.
struct Concatenate {
  template <class T>
  T operator()(T a, const T& b) const {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }
};
inline constexpr Sum sum{};
inline constexpr Min min{};
inline constexpr Max max{};
inline constexpr LogicalAnd logical_and{};
inline constexpr LogicalOr logical_or{};
inline constexpr Concatenate concatenate{};

/// The list of all pairs (index, value), in the order of indices, whose type has an operator<:
/// contribute(tess::gather, x, target) with a Callback<std::vector<std::pair<Index, T>>>.
struct Gather {};
inline constexpr Gather gather{};

/// An operation that is applied in the order of indices, once all values are at the root.
template <class Op>
struct InOrder {
  [[no_unique_address]] Op op;
};
template <class Op>
[[nodiscard]] constexpr InOrder<Op> in_order(Op op) {
  return {std::move(op)};
}

}  // namespace tess
