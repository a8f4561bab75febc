// The reductions that are open on one PE, by number: what has been gathered to each until it is
// passed on. A ReductionTree keeps what the elements here contribute in it, and its root what has
// arrived.
//
// Elements mostly contribute one after the other to one number. So the sum that got the last
// contribution is remembered, and more of the same kind and epoch are added to it in place.
#pragma once

#include "runtime/pe/completion/counted.hpp"
#include "runtime/reduce/gathered.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <utility>

namespace tess::detail {

/// `Sum` is a Gathered, or derives from it.
template <class Sum>
class OpenSums {
 public:
  /// The sum of a number; an empty one is made if there is none.
  [[nodiscard]] Sum& operator[](std::uint32_t number) { return sums_[number]; }
  /// Null if there is none.
  [[nodiscard]] Sum* find(std::uint32_t number) {
    const auto at = sums_.find(number);
    return at == sums_.end() ? nullptr : &at->second;
  }
  [[nodiscard]] const Sum* find(std::uint32_t number) const {
    const auto at = sums_.find(number);
    return at == sums_.end() ? nullptr : &at->second;
  }
  /// Takes a sum out; it is empty if there is none.
  [[nodiscard]] Sum take(std::uint32_t number) {
    if (number == current_number_) current_ = nullptr;
    auto node = sums_.extract(number);
    return node.empty() ? Sum() : std::move(node.mapped());
  }

  /// Adds a contribution to a number.
  Sum& add(Completion& completion, std::uint32_t number, EpochId epoch,
           std::unique_ptr<Partial> value) {
    Sum& sum = sums_[number];
    sum.add(completion, epoch, std::move(value));
    current_ = &sum;
    current_number_ = number;
    return sum;
  }
  /// The value of a number, if a contribution of this kind and epoch can be added in place;
  /// otherwise null, then call add(). After adding, the caller calls added().
  [[nodiscard]] Partial* open(std::uint32_t number, const PartialKind& kind, EpochId epoch) {
    if (current_ == nullptr || current_number_ != number || !current_->takes(kind, epoch))
      return nullptr;
    return current_->value.held.get();
  }
  /// A contribution was added to open(). Returns the sum.
  Sum& added(Completion& completion) {
    Counted::departs(completion, current_->shares.front().epoch);
    ++current_->shares.front().n;
    ++current_->n;
    return *current_;
  }

  /// The reductions end: what was gathered is dropped, and counted as processed in its epochs.
  void drop(Completion& completion) {
    for (const auto& [number, sum] : sums_) settle(completion, sum.shares);
    sums_.clear();
    current_ = nullptr;
  }

  // In the order of numbers.
  [[nodiscard]] bool empty() const { return sums_.empty(); }
  [[nodiscard]] auto begin() const { return sums_.begin(); }
  [[nodiscard]] auto end() const { return sums_.end(); }

 private:
  std::map<std::uint32_t, Sum> sums_;
  Sum* current_ = nullptr;  // that which got the last contribution
  std::uint32_t current_number_ = 0;
};

}  // namespace tess::detail
