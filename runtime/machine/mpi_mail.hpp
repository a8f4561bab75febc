// What one call of progress() received, for the PE that made it: small buffers side by side in one
// block that is used again, others on their own. One thread's.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace tess {

class Mail {
 public:
  void clear() {
    items_.clear();
    own_.clear();
    used_ = 0;
  }
  [[nodiscard]] bool full() const { return items_.size() >= most_items || used_ >= block_bytes; }
  [[nodiscard]] std::span<const std::span<const std::byte>> items() const { return items_; }

  std::byte* add(std::size_t n_bytes) {
    if (used_ + n_bytes > block_bytes)
      return add(std::make_unique_for_overwrite<std::byte[]>(n_bytes), n_bytes);
    std::byte* const place = block_.get() + used_;
    used_ += (n_bytes + 15) / 16 * 16;
    items_.emplace_back(place, n_bytes);
    return place;
  }
  std::byte* add(std::unique_ptr<std::byte[]> bytes, std::size_t n_bytes) {
    items_.emplace_back(bytes.get(), n_bytes);
    own_.push_back(std::move(bytes));
    return own_.back().get();
  }

 private:
  static constexpr std::size_t block_bytes = std::size_t{64} * 1024;
  static constexpr std::size_t most_items = 16;

  std::unique_ptr<std::byte[]> block_ = std::make_unique_for_overwrite<std::byte[]>(block_bytes);
  std::size_t used_ = 0;
  std::vector<std::span<const std::byte>> items_;
  std::vector<std::unique_ptr<std::byte[]>> own_;
};

}  // namespace tess
