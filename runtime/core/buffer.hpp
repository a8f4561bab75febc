// The bytes of a message: a block of memory that is never filled with zeros and grows only on
// request. A std::vector would fill new bytes with zeros that are overwritten at once.
#pragma once

#include "runtime/core/algorithm.hpp"

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

namespace tess::detail {

class Buffer {
 public:
  using value_type = std::byte;

  Buffer() = default;
  /// `n` bytes of unspecified value.
  explicit Buffer(std::size_t n) { resize(n); }
  Buffer(Buffer&& other) noexcept
      : bytes_(std::move(other.bytes_)),
        size_(std::exchange(other.size_, 0)),
        capacity_(std::exchange(other.capacity_, 0)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    bytes_ = std::move(other.bytes_);
    size_ = std::exchange(other.size_, 0);
    capacity_ = std::exchange(other.capacity_, 0);
    return *this;
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() = default;

  [[nodiscard]] std::byte* data() { return bytes_.get(); }
  [[nodiscard]] const std::byte* data() const { return bytes_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  std::byte& operator[](std::size_t i) { return bytes_[i]; }
  const std::byte& operator[](std::size_t i) const { return bytes_[i]; }

  /// Removes all bytes; keeps the memory.
  void clear() { size_ = 0; }
  /// Reserves memory for `n` bytes in total; keeps the contents.
  void reserve(std::size_t n) {
    if (n <= capacity_) return;
    auto larger = std::make_unique_for_overwrite<std::byte[]>(n);
    if (size_ != 0) std::memcpy(larger.get(), bytes_.get(), size_);
    bytes_ = std::move(larger);
    capacity_ = n;
  }
  /// New bytes have unspecified values.
  void resize(std::size_t n) {
    reserve(n);
    size_ = n;
  }
  void append(std::span<const std::byte> bytes) {
    if (bytes.empty()) return;
    if (bytes.size() > capacity_ - size_) reserve(std::max(2 * capacity_, size_ + bytes.size()));
    std::memcpy(bytes_.get() + size_, bytes.data(), bytes.size());
    size_ += bytes.size();
  }
  /// The memory that is reserved and not used yet.
  [[nodiscard]] std::span<std::byte> room() { return {bytes_.get() + size_, capacity_ - size_}; }

 private:
  std::unique_ptr<std::byte[]> bytes_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace tess::detail
