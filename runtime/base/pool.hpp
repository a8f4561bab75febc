// Blocks of memory for messages: one pool per PE, seventeen size classes with a free list each. The
// pool's PE allocates and frees without atomics. A block that another PE frees is returned to its
// pool in batches over a stack, which the owner empties when one of its lists is empty. So a flow
// in one direction reuses its blocks, and memory is bounded by the largest amount that was in use
// at once.
//
//     block:  | owner 8 | class 8 |  memory of the caller, 16-byte aligned …  |   64, 128 … bytes
//
// Large blocks, and blocks of threads without a pool, come from operator new. So do all blocks
// under AddressSanitizer, which then detects each use after free. Blocks must be freed before the
// pools of their process are destroyed.
#pragma once

#include "runtime/base/mpsc_queue.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

namespace tess::detail {

class Pool {
 public:
#if defined(__SANITIZE_ADDRESS__)
  static constexpr bool reuses_blocks = false;
#else
  static constexpr bool reuses_blocks = true;
#endif
  /// The largest request that a size class serves.
  static constexpr std::size_t most_bytes = 1024;

  Pool() = default;
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() = default;

  /// Uninitialised memory, aligned to 16 bytes. Only the thread of this pool's PE may call it.
  [[nodiscard]] void* allocate(std::size_t bytes) {
    const std::size_t size_class = (bytes + sizeof(Header) - 1) / granule;
    if (!reuses_blocks || size_class >= n_classes) return allocate_unpooled(bytes);
    // The last block that came from another PE is in this core's cache: an answer is written to it.
    if (Link* const hot = borrowed_[size_class]; hot != nullptr) {
      borrowed_[size_class] = nullptr;
      return hot;
    }
    Link* const link = free_[size_class];
    if (link == nullptr) [[unlikely]]
      return refill(size_class);
    free_[size_class] = link->next;
    return link;
  }

  /// The same for a thread without a pool (`mine` is null).
  [[nodiscard]] static void* allocate(std::size_t bytes, Pool* mine) {
    return mine != nullptr ? mine->allocate(bytes) : allocate_unpooled(bytes);
  }

  /// Frees a block of any pool. `mine` is the pool of the calling thread's PE, null if it has none.
  static void release(void* block, Pool* mine) noexcept {
    Header* const header = header_of(block);
    auto* const link = ::new (block) Link;
    if (header->owner == nullptr)
      ::operator delete(header);
    else if (header->owner == mine) {
      link->next = mine->free_[header->size_class];
      mine->free_[header->size_class] = link;
    } else if (mine != nullptr) {
      Link*& hot = mine->borrowed_[header->size_class];
      if (hot != nullptr) mine->give_back(header_of(hot)->owner, hot);
      hot = link;
    } else
      header->owner->returned_.push(link);
  }

  /// Returns the unfinished batches to their owners; called when the PE idles.
  void flush() noexcept;

  /// Bytes this pool holds, used or free.
  [[nodiscard]] std::size_t held_bytes() const { return held_bytes_; }

 private:
  struct Header {
    Pool* owner;
    std::size_t size_class;
  };
  static_assert(sizeof(Header) == 16);

  /// Blocks to be returned to one owner.
  struct Batch {
    Pool* owner = nullptr;
    Link* first = nullptr;
    Link* last = nullptr;
    std::uint32_t n = 0;
  };

  struct Free {
    void operator()(std::byte* slab) const { ::operator delete(slab, std::align_val_t{granule}); }
  };

  static constexpr std::size_t granule = 64;  // a cache line: no two blocks share one
  static constexpr std::size_t n_classes = (most_bytes + sizeof(Header) + granule - 1) / granule;
  static constexpr std::size_t first_slab_bytes = std::size_t{4} * 1024;  // doubles up to the last
  static constexpr std::size_t last_slab_bytes = std::size_t{64} * 1024;
  static constexpr std::uint32_t batch_most = 32;
  static constexpr std::size_t n_batches = 8;

  static Header* header_of(void* block) { return static_cast<Header*>(block) - 1; }
  [[nodiscard]] static void* allocate_unpooled(std::size_t bytes);
  [[nodiscard]] void* refill(std::size_t size_class);
  void take_returned() noexcept;
  void carve(std::size_t size_class);
  void give_back(Pool* owner, Link* link) noexcept;
  static void send(Batch& batch) noexcept;

  std::array<Link*, n_classes> free_{};
  std::array<Link*, n_classes> borrowed_{};        // of another pool, at most one per class
  std::array<std::uint8_t, n_classes> n_slabs_{};  // slabs per class; each doubles the last
  std::array<Batch, n_batches> batches_{};
  std::vector<std::unique_ptr<std::byte, Free>> slabs_;
  std::size_t held_bytes_ = 0;
  alignas(64) MpscQueue returned_;  // other threads write it
};

}  // namespace tess::detail
