// Partial results of reductions over values of type T: merged immediately, or kept with their
// indices and combined in order at the end.
#pragma once

#include "runtime/callback.hpp"
#include "runtime/collections/partial.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace tess::detail {

/// Merges immediately.
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
  static inline const PartialKind kind_{naming::name_of<MergedPartial>(), &unpack};

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
  static inline const PartialKind kind_{naming::name_of<OrderedPartial>(), &unpack};

  std::vector<std::pair<Index, T>> values_;
  Callback<T> target_;
};

}  // namespace tess::detail
