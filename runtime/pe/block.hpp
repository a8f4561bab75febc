// Allocation of messages: memory comes from the pool of the PE that creates a message, and is
// released through the pool of the PE that ends it.
#pragma once

#include "runtime/base/pool.hpp"
#include "runtime/pe/pe.hpp"

namespace tess::detail {

[[nodiscard]] inline void* allocate_block(Pe& pe, std::size_t n_bytes) {
  return pe.pool().allocate(n_bytes);
}
/// The same for a message from another process: not inline, since its transfer takes far longer.
[[nodiscard]] void* allocate_received(Pe& pe, std::size_t n_bytes);
inline void release_block(void* block, std::size_t /*n_bytes*/) {
  Pe* const pe = current_pe_or_null();
  Pool::release(block, pe != nullptr ? &pe->pool() : nullptr);
}

/// Ends a message whose arguments need no destructor.
void release_message(Envelope* message);
/// The function that ends messages of this type: its own, or the common one if it needs no
/// destructor.
template <class Message>
[[nodiscard]] constexpr Action::Destroy destroy_of() {
  if constexpr (std::is_trivially_destructible_v<Message>) {
    return &release_message;
  } else {
    return &Message::destroy;
  }
}

/// An allocator for nodes of containers in chares: takes memory from the pool of the running PE.
template <class T>
struct PoolAllocator {
  using value_type = T;
  // NOLINTNEXTLINE(bugprone-sizeof-expression): nodes may be pointers
  static constexpr std::size_t bytes_each = sizeof(value_type);
  PoolAllocator() = default;
  template <class Other>
  PoolAllocator(const PoolAllocator<Other>& /*other*/) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] T* allocate(std::size_t n) {
    static_assert(alignof(T) <= 16, "blocks of the pool are aligned to 16 bytes");
    Pe* const pe = current_pe_or_null();
    return static_cast<T*>(Pool::allocate(n * bytes_each, pe != nullptr ? &pe->pool() : nullptr));
  }
  void deallocate(T* at, std::size_t n) { release_block(at, n * bytes_each); }
  friend bool operator==(const PoolAllocator&, const PoolAllocator&) { return true; }
};

}  // namespace tess::detail
