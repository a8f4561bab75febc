// Combining one value from each element: contribute(tess::sum, value, target). The operations here,
// or any empty function object that combines two values: `struct Longest { std::string
// operator()(std::string a, std::string b) const; };` It must be associative and commutative;
// in_order(op) combines in the order of indices, so that a floating-point result does not depend on
// where the elements are.
#pragma once

#include "runtime/callback.hpp"
#include "runtime/collections/partial.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace tess {

namespace detail {
template <class T>
concept Listable = requires(T a) {
  a.begin();
  a.size();
  a[0];
} && !std::is_convertible_v<T, std::string_view>;

/// Applies an operation to numbers, or element by element to vectors and arrays of one length.
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
}  // namespace detail

struct Sum {
  template <class T>
  T operator()(T a, const T& b) const {
    return detail::elementwise(std::move(a), b, [](const auto& x, const auto& y) {
      return static_cast<std::decay_t<decltype(x)>>(x + y);
    });
  }
};
struct Min {
  template <class T>
  T operator()(T a, const T& b) const {
    return detail::elementwise(std::move(a), b,
                               [](const auto& x, const auto& y) { return y < x ? y : x; });
  }
};
struct Max {
  template <class T>
  T operator()(T a, const T& b) const {
    return detail::elementwise(std::move(a), b,
                               [](const auto& x, const auto& y) { return x < y ? y : x; });
  }
};
struct LogicalAnd {
  bool operator()(bool a, bool b) const { return a && b; }
};
struct LogicalOr {
  bool operator()(bool a, bool b) const { return a || b; }
};
/// Vectors (or strings) behind one another, in no promised order unless in_order().
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

/// The same operation, applied in the order of indices once all values are at the root.
template <class Op>
struct InOrder {};
template <class Op>
[[nodiscard]] constexpr InOrder<Op> in_order(Op /*op*/) {
  return {};
}

/// Merges as it goes.
template <class T, class Op>
class MergedPartial final : public Partial {
 public:
  MergedPartial(T value, Callback<T> target)
      : value_(std::move(value)), target_(std::move(target)) {}

  static const PartialKind& its_kind() { return kind_; }
  [[nodiscard]] const PartialKind& kind() const override { return kind_; }
  void add(const T& value) { value_ = Op()(std::move(value_), value); }
  void merge(Partial&& other) override {
    value_ = Op()(std::move(value_), static_cast<MergedPartial&>(other).value_);
  }
  void pack(Writer& ar) const override { ar(value_, target_); }
  void complete(Pe& /*pe*/) override { target_(std::move(value_)); }

 private:
  static std::unique_ptr<Partial> unpack(Reader& ar) {
    auto value = ar.take<T>();
    auto target = ar.take<Callback<T>>();
    return std::make_unique<MergedPartial>(std::move(value), std::move(target));
  }
  static inline const PartialKind kind_{name_of_type<MergedPartial>, &unpack};

  T value_;
  Callback<T> target_;
};

/// Keeps the values with their indices, and combines them in the order of indices at the end.
template <class T, class Op, class Index>
class OrderedPartial final : public Partial {
 public:
  OrderedPartial(std::vector<std::pair<Index, T>> values, Callback<T> target)
      : values_(std::move(values)), target_(std::move(target)) {}

  [[nodiscard]] const PartialKind& kind() const override { return kind_; }
  void merge(Partial&& other) override {
    auto& more = static_cast<OrderedPartial&>(other).values_;
    values_.insert(values_.end(), std::make_move_iterator(more.begin()),
                   std::make_move_iterator(more.end()));
  }
  void pack(Writer& ar) const override { ar(values_, target_); }
  void complete(Pe& /*pe*/) override {
    std::sort(values_.begin(), values_.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    T whole = std::move(values_.front().second);
    for (std::size_t i = 1; i < values_.size(); ++i)
      whole = Op()(std::move(whole), values_[i].second);
    target_(std::move(whole));
  }

 private:
  static std::unique_ptr<Partial> unpack(Reader& ar) {
    auto values = ar.take<std::vector<std::pair<Index, T>>>();
    auto target = ar.take<Callback<T>>();
    return std::make_unique<OrderedPartial>(std::move(values), std::move(target));
  }
  static inline const PartialKind kind_{name_of_type<OrderedPartial>, &unpack};

  std::vector<std::pair<Index, T>> values_;
  Callback<T> target_;
};

}  // namespace tess
