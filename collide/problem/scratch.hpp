// An array that grows and is not filled with zeros: memory that a search writes before it reads.
#pragma once

#include "runtime/core/algorithm.hpp"

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

namespace tess::collide::search {

template <class T>
class Scratch {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Scratch() = default;
  Scratch(Scratch&& other) noexcept { swap(other); }
  Scratch& operator=(Scratch&& other) noexcept {
    swap(other);
    return *this;
  }
  /// `size` values; what was there remains, the rest is not set.
  void resize(std::size_t size) {
    if (size > capacity_) grow(std::max(size, capacity_ + capacity_ / 2));
    size_ = size;
  }
  /// Room for `n` values behind data(), of which size() are in use.
  void reserve(std::size_t n) {
    if (n > capacity_) grow(std::max(n, capacity_ + capacity_ / 2));
  }
  void push_back(const T& value) {
    resize(size_ + 1);
    data_[size_ - 1] = value;
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }
  [[nodiscard]] T* data() noexcept { return data_.get(); }
  [[nodiscard]] const T* data() const noexcept { return data_.get(); }
  [[nodiscard]] std::size_t bytes() const noexcept { return capacity_ * sizeof(T); }

 private:
  static constexpr std::align_val_t line{64};
  struct Free {
    void operator()(T* data) const noexcept { ::operator delete(data, line); }
  };
  void grow(std::size_t n) {
    constexpr auto per_line = static_cast<std::size_t>(line);
    const std::size_t bytes = (n * sizeof(T) + per_line - 1) / per_line * per_line;
    std::unique_ptr<T[], Free> larger(static_cast<T*>(::operator new(bytes, line)));
    if (capacity_ != 0) std::memcpy(larger.get(), data_.get(), capacity_ * sizeof(T));
    data_ = std::move(larger);
    capacity_ = bytes / sizeof(T);
  }

  void swap(Scratch& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  std::unique_ptr<T[], Free> data_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace tess::collide::search
