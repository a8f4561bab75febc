// What one call of progress() received, for the PE that made it. A buffer of the usual size stays
// in the block it was received into, and the receiver is given an empty block of ours for it: no
// bytes are copied, no memory is allocated. What is larger comes on its own. One thread's.
#pragma once

#include "runtime/machine/machine.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tess {

/// A large buffer, or a parcel, that comes in chunks: first its bytes, unless they came with the
/// announcement; then, where the program wants them, its parts.
struct Incoming : Link {
  int source = 0;
  int tag = 0;
  std::vector<std::uint64_t> sizes;  // of the parts; a buffer has none
  Buffer bytes;
  std::size_t n_requests = 0;  // not yet complete
  bool has_bytes = false;
  Link* message = nullptr;                   // once the program has seen the bytes
  std::vector<std::span<std::byte>> places;  // of the parts
};

/// What is on its way out, until MPI has all of it.
struct Outgoing : Link {
  int to = 0;
  int tag = 0;
  bool announces = false;
  Buffer first;  // all of it, or its announcement
  Parcel rest;
  std::size_t n_requests = 0;  // not yet complete
};

class Mail {
 public:
  using Block = std::unique_ptr<std::byte[]>;

  /// A call of progress() that always finds something leaves the rest to the next one.
  static constexpr std::size_t most_items = 16;

  /// Of each block, here and at the receiver.
  explicit Mail(std::size_t block_bytes) : block_bytes_(block_bytes) {}

  /// Frees what was sent, too; not under the lock, for that is work of the program.
  void clear() {
    items_.clear();
    large.clear();
    sent.clear();
    n_used_ = 0;
  }
  [[nodiscard]] std::size_t size() const { return items_.size() + large.size(); }
  [[nodiscard]] std::span<const std::span<const std::byte>> items() const { return items_; }

  /// Takes a block that is filled so far, and leaves an empty one in its place.
  void exchange(Block& block, std::size_t n_bytes) {
    items_.emplace_back(block.get(), n_bytes);
    if (n_used_ == blocks_.size())
      blocks_.push_back(std::make_unique_for_overwrite<std::byte[]>(block_bytes_));
    std::swap(block, blocks_[n_used_++]);
  }

  /// Of each the bytes have come, or all parts.
  std::vector<std::unique_ptr<Incoming>> large;
  std::vector<std::unique_ptr<Outgoing>> sent;

 private:
  std::size_t block_bytes_;
  std::size_t n_used_ = 0;
  std::vector<Block> blocks_;  // the first n_used_ are filled
  std::vector<std::span<const std::byte>> items_;
};

}  // namespace tess
