// Partial results of reductions over values of type T: merged immediately, or kept with their
// indices and combined in order at the end.
#pragma once

#include "runtime/callback.hpp"
#include "runtime/core/algorithm.hpp"
#include "runtime/reduce/partial.hpp"
#include "runtime/reduction.hpp"

#include <concepts>
#include <memory>
#include <utility>
#include <vector>

namespace tess::detail {

/// All contributions to a reduction give one operation, as far as operations can be compared.
template <class Op>
void require_one_operation(const Op& op, const Op& other) {
  if constexpr (!std::is_empty_v<Op> && std::equality_comparable<Op>)
    TESS_CHECK(op == other, "contributions to one reduction have operations ", name_of_type<Op>,
               " of different state: all elements must give the same");
}
/// The same, and one target.
template <class Op, class T>
void require_one(const Op& op, const Op& other, const Callback<T>& target,
                 const Callback<T>& other_target) {
  TESS_CHECK(target == other_target,
             "contributions to one reduction have different targets: ", target.name(), " and ",
             other_target.name());
  require_one_operation(op, other);
}

/// An operation with a finishing step.
template <class Op, class T>
concept Finishes = requires(const Op& op, T value) {
  op.combine(std::move(value), value);
  op.finish(std::move(value));
};
/// The type of the result of a reduction over values of type T.
template <class Op, class T, class Key>
struct ResultOf : std::type_identity<T> {};
template <class Op, class T, class Key>
  requires Finishes<Op, T>
struct ResultOf<Op, T, Key>
    : std::type_identity<
          std::decay_t<decltype(std::declval<const Op&>().finish(std::declval<T>()))>> {};
template <class Op, class T, class Key>
struct ResultOf<InOrder<Op>, T, Key> : ResultOf<Op, T, Key> {};
template <class T, class Key>
struct ResultOf<Gather, T, Key> : std::type_identity<std::vector<std::pair<Key, T>>> {};

template <class Op, class T>
[[nodiscard]] T combined(const Op& op, T a, const T& b) {
  return call_user([&]() -> T {
    if constexpr (Finishes<Op, T>) {
      return op.combine(std::move(a), b);
    } else {
      return op(std::move(a), b);
    }
  });
}
template <class Op, class T>
[[nodiscard]] auto finished(const Op& op, T whole) {
  if constexpr (Finishes<Op, T>) {
    return op.finish(std::move(whole));
  } else {
    return whole;
  }
}

/// Merges immediately.
template <class T, class Op, class Result = T>
class MergedPartial final : public Partial {
 public:
  MergedPartial(Op op, T value, Callback<Result> target)
      : op_(std::move(op)), value_(std::move(value)), target_(std::move(target)) {}

  static const PartialKind& its_kind() { return kind_; }
  [[nodiscard]] const PartialKind& kind() const override { return kind_; }
  void add(const Op& op, const T& value, const Callback<Result>& target) {
    require_one(op_, op, target_, target);
    value_ = combined(op_, std::move(value_), value);
  }
  void merge(Partial&& other) override {
    auto& more = static_cast<MergedPartial&>(other);
    add(more.op_, more.value_, more.target_);
  }
  void pack(Writer& ar) const override { ar(op_, value_, target_); }
  void complete(Pe& /*pe*/) override { target_(finished(op_, std::move(value_))); }

 private:
  static std::unique_ptr<Partial> unpack(Reader& ar) {
    auto op = ar.take<Op>();
    auto value = ar.take<T>();
    auto target = ar.take<Callback<Result>>();
    return std::make_unique<MergedPartial>(std::move(op), std::move(value), std::move(target));
  }
  static inline const PartialKind kind_{naming::name_of_polymorphic<MergedPartial>(), &unpack};

  [[no_unique_address]] Op op_;
  T value_;
  Callback<Result> target_;
};

/// Keeps the values with their indices, and combines them in the order of indices at the end.
template <class T, class Op, class Index, class Result = T>
class OrderedPartial final : public Partial {
 public:
  OrderedPartial(Op op, std::vector<std::pair<Index, T>> values, Callback<Result> target)
      : op_(std::move(op)), values_(std::move(values)), target_(std::move(target)) {}

  [[nodiscard]] const PartialKind& kind() const override { return kind_; }
  void merge(Partial&& other) override {
    require_one(op_, static_cast<OrderedPartial&>(other).op_, target_,
                static_cast<OrderedPartial&>(other).target_);
    auto& more = static_cast<OrderedPartial&>(other).values_;
    values_.insert(values_.end(), std::make_move_iterator(more.begin()),
                   std::make_move_iterator(more.end()));
  }
  void pack(Writer& ar) const override { ar(op_, values_, target_); }
  void complete(Pe& /*pe*/) override {
    std::sort(values_.begin(), values_.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    if constexpr (std::is_same_v<Op, Gather>) {
      target_(std::move(values_));
    } else {
      T whole = std::move(values_.front().second);
      for (std::size_t i = 1; i < values_.size(); ++i)
        whole = combined(op_, std::move(whole), values_[i].second);
      target_(finished(op_, std::move(whole)));
    }
  }

 private:
  static std::unique_ptr<Partial> unpack(Reader& ar) {
    auto op = ar.take<Op>();
    auto values = ar.take<std::vector<std::pair<Index, T>>>();
    auto target = ar.take<Callback<Result>>();
    return std::make_unique<OrderedPartial>(std::move(op), std::move(values), std::move(target));
  }
  static inline const PartialKind kind_{naming::name_of_polymorphic<OrderedPartial>(), &unpack};

  [[no_unique_address]] Op op_;
  std::vector<std::pair<Index, T>> values_;
  Callback<Result> target_;
};

}  // namespace tess::detail
