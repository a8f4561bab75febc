// The buffers that one call of progress() received, for the calling PE. A buffer of the usual size
// stays in the block into which it was received, and the receiver gets an empty block in exchange:
// no bytes are copied and no memory is allocated. Larger buffers arrive separately. Used by one
// thread.
#pragma once

#include "runtime/wire/machine/machine.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tess::detail {

/// A large buffer or a parcel that arrives in chunks: first its bytes, unless the announcement
/// contained them; then its parts, to the places that the program names.
struct Incoming : Link {
  int source = 0;
  int tag = 0;
  std::vector<std::uint64_t> sizes;  // sizes of the parts; a buffer has none
  Buffer bytes;
  std::size_t n_requests = 0;  // not yet complete
  bool has_bytes = false;
  Link* message = nullptr;                   // set once the program has seen the bytes
  std::vector<std::span<std::byte>> places;  // of the parts
};

/// A transfer that is being sent, until MPI is done with its memory.
struct Outgoing : Link {
  int to = 0;
  int tag = 0;
  bool announces = false;
  Buffer first;  // the whole buffer, or the announcement
  Parcel rest;
  std::size_t n_requests = 0;  // not yet complete
};

class Mail {
 public:
  using Block = std::unique_ptr<std::byte[]>;

  /// One call of progress() takes at most so many items and leaves the rest to the next call.
  static constexpr std::size_t most_items = 16;

  /// The size of each block, here and at the receiver.
  explicit Mail(std::size_t block_bytes) : block_bytes_(block_bytes) {}

  /// Also frees what was sent. Not called under the lock, since freeing runs code of the program.
  void clear() {
    items_.clear();
    large.clear();
    sent.clear();
    n_used_ = 0;
  }
  [[nodiscard]] std::size_t size() const { return items_.size() + large.size(); }
  [[nodiscard]] std::span<const std::span<const std::byte>> items() const { return items_; }

  /// Takes a block that is filled up to `n_bytes` and leaves an empty one in its place.
  void exchange(Block& block, std::size_t n_bytes) {
    items_.emplace_back(block.get(), n_bytes);
    if (n_used_ == blocks_.size())
      blocks_.push_back(std::make_unique_for_overwrite<std::byte[]>(block_bytes_));
    std::swap(block, blocks_[n_used_++]);
  }

  /// Large transfers whose bytes have arrived, or all of whose parts have.
  std::vector<std::unique_ptr<Incoming>> large;
  std::vector<std::unique_ptr<Outgoing>> sent;

 private:
  std::size_t block_bytes_;
  std::size_t n_used_ = 0;
  std::vector<Block> blocks_;  // the first n_used_ are filled
  std::vector<std::span<const std::byte>> items_;
};

}  // namespace tess::detail
