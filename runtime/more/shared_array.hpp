// tess::SharedArray<T>: numbers that are computed once and then only read, by any number of owners.
//
//     std::vector<double> values = …;
//     const tess::SharedArray<double> edge(std::move(values));   // no copy
//     left.send<&Block::receive>(edge);                          // no copy
//     right.send<&Block::receive>(edge);
//
// A copy is another owner of the same memory, on any PE of the process; the last owner frees it. A
// message to another process sends the numbers from this memory, which it owns until they are sent,
// and receives them into new memory; only MPI may copy them. A reference to a number or a span is
// valid while there is an owner.
#pragma once

#include "runtime/core/algorithm.hpp"
#include "runtime/core/serialize.hpp"

#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace tess {

template <class T>
class SharedArray {
  static_assert(Bitwise<T> && !std::is_same_v<T, bool>,
                "a SharedArray holds numbers, or aggregates of numbers without padding");

 public:
  using value_type = T;

  SharedArray() = default;
  /// Takes over the memory of the vector.
  explicit SharedArray(std::vector<T>&& values)
      : values_(std::make_shared<const std::vector<T>>(std::move(values))) {}

  [[nodiscard]] std::size_t size() const { return values_ ? values_->size() : 0; }
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] const T* data() const { return values_ ? values_->data() : nullptr; }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size(); }
  [[nodiscard]] const T& operator[](std::size_t i) const { return (*values_)[i]; }
  [[nodiscard]] std::span<const T> view() const { return {data(), size()}; }

  /// True if the numbers are equal, in the same memory or not.
  friend bool operator==(const SharedArray& a, const SharedArray& b) {
    return a.values_ == b.values_ || std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (Ar::is_reading) {
      std::vector<T> values;
      ar.template numbers<T>([&values](std::size_t n) {
        resize_uninitialised(values, n);
        return values.data();
      });
      *this = SharedArray(std::move(values));  // the vector moves, its memory does not
    } else {
      ar.numbers(view(), values_);
    }
  }

 private:
  std::shared_ptr<const std::vector<T>> values_;
};

}  // namespace tess
