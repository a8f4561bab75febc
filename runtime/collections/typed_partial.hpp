// Partial results of reductions over values of type T: merged immediately, or kept with their
// indices and combined in order at the end.
#pragma once

#include "runtime/callback.hpp"
#include "runtime/collections/partial.hpp"
#include "runtime/core/algorithm.hpp"

#include <concepts>
#include <memory>
#include <utility>
#include <vector>

namespace tess::detail {

/// All contributions to a reduction give one target, and one operation as far as operations can be
/// compared.
template <class Op, class T>
void require_one(const Op& op, const Op& other, const Callback<T>& target,
                 const Callback<T>& other_target) {
  TESS_CHECK(target == other_target,
             "contributions to one reduction have different targets: ", target.name(), " and ",
             other_target.name());
  if constexpr (!std::is_empty_v<Op> && std::equality_comparable<Op>)
    TESS_CHECK(op == other, "contributions to one reduction have operations ", name_of_type<Op>,
               " of different state: all elements must give the same");
}

/// Merges immediately.
template <class T, class Op>
class MergedPartial final : public Partial {
 public:
  MergedPartial(Op op, T value, Callback<T> target)
      : op_(std::move(op)), value_(std::move(value)), target_(std::move(target)) {}

  static const PartialKind& its_kind() { return kind_; }
  [[nodiscard]] const PartialKind& kind() const override { return kind_; }
  void add(const Op& op, const T& value, const Callback<T>& target) {
    require_one(op_, op, target_, target);
    value_ = op_(std::move(value_), value);
  }
  void merge(Partial&& other) override {
    auto& more = static_cast<MergedPartial&>(other);
    add(more.op_, more.value_, more.target_);
  }
  void pack(Writer& ar) const override { ar(op_, value_, target_); }
  void complete(Pe& /*pe*/) override { target_(std::move(value_)); }

 private:
  static std::unique_ptr<Partial> unpack(Reader& ar) {
    auto op = ar.take<Op>();
    auto value = ar.take<T>();
    auto target = ar.take<Callback<T>>();
    return std::make_unique<MergedPartial>(std::move(op), std::move(value), std::move(target));
  }
  static inline const PartialKind kind_{naming::name_of<MergedPartial>(), &unpack};

  [[no_unique_address]] Op op_;
  T value_;
  Callback<T> target_;
};

/// Keeps the values with their indices, and combines them in the order of indices at the end.
template <class T, class Op, class Index>
class OrderedPartial final : public Partial {
 public:
  OrderedPartial(Op op, std::vector<std::pair<Index, T>> values, Callback<T> target)
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
    T whole = std::move(values_.front().second);
    for (std::size_t i = 1; i < values_.size(); ++i)
      whole = op_(std::move(whole), values_[i].second);
    target_(std::move(whole));
  }

 private:
  static std::unique_ptr<Partial> unpack(Reader& ar) {
    auto op = ar.take<Op>();
    auto values = ar.take<std::vector<std::pair<Index, T>>>();
    auto target = ar.take<Callback<T>>();
    return std::make_unique<OrderedPartial>(std::move(op), std::move(values), std::move(target));
  }
  static inline const PartialKind kind_{naming::name_of<OrderedPartial>(), &unpack};

  [[no_unique_address]] Op op_;
  std::vector<std::pair<Index, T>> values_;
  Callback<T> target_;
};

}  // namespace tess::detail
