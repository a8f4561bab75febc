// What one call of progress() received, for the PE that made it. A buffer of the usual size stays
// in the block it was received into, and the receiver is given an empty block of ours for it: no
// bytes are copied, no memory is allocated. Larger buffers come on their own. One thread's.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tess {

class Mail {
 public:
  using Block = std::unique_ptr<std::byte[]>;

  /// A call of progress() that always finds something leaves the rest to the next one.
  static constexpr std::size_t most_items = 16;

  /// Of each block, here and at the receiver.
  explicit Mail(std::size_t block_bytes) : block_bytes_(block_bytes) {}

  void clear() {
    items_.clear();
    own_.clear();
    n_used_ = 0;
  }
  [[nodiscard]] std::size_t size() const { return items_.size(); }
  [[nodiscard]] std::span<const std::span<const std::byte>> items() const { return items_; }

  /// Takes a block that is filled so far, and leaves an empty one in its place.
  void exchange(Block& block, std::size_t n_bytes) {
    items_.emplace_back(block.get(), n_bytes);
    if (n_used_ == blocks_.size())
      blocks_.push_back(std::make_unique_for_overwrite<std::byte[]>(block_bytes_));
    std::swap(block, blocks_[n_used_++]);
  }
  /// Takes a buffer of its own size.
  void add(Block bytes, std::size_t n_bytes) {
    items_.emplace_back(bytes.get(), n_bytes);
    own_.push_back(std::move(bytes));
  }

 private:
  std::size_t block_bytes_;
  std::size_t n_used_ = 0;
  std::vector<Block> blocks_;  // the first n_used_ are filled
  std::vector<std::span<const std::byte>> items_;
  std::vector<Block> own_;
};

}  // namespace tess
