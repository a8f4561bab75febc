// An allocator for large tables with random access. For sizes of a few MiB and above it requests
// huge pages from the system, so that a lookup does not also miss the address translation cache.
#pragma once

#include <cstddef>
#include <new>

namespace tess::detail {

inline constexpr std::size_t huge_page_bytes = std::size_t{2} << 20U;
/// Memory for a large table, aligned to huge pages and advised to consist of them.
[[nodiscard]] void* allocate_huge_pages(std::size_t n_bytes);
void free_huge_pages(void* memory) noexcept;

template <class T>
struct HugePageAllocator {
  using value_type = T;
  HugePageAllocator() = default;
  // Containers convert allocators implicitly.
  template <class Other>
  // NOLINTNEXTLINE(google-explicit-constructor)
  HugePageAllocator(const HugePageAllocator<Other>& /*other*/) {}

  [[nodiscard]] T* allocate(std::size_t n) {
    const std::size_t n_bytes = n * sizeof(T);
    if (n_bytes < 2 * huge_page_bytes) return static_cast<T*>(::operator new(n_bytes));
    return static_cast<T*>(allocate_huge_pages(n_bytes));
  }
  void deallocate(T* at, std::size_t n) {
    if (n * sizeof(T) < 2 * huge_page_bytes) {
      ::operator delete(at);
    } else {
      free_huge_pages(at);
    }
  }
  friend bool operator==(const HugePageAllocator&, const HugePageAllocator&) { return true; }
};

}  // namespace tess::detail
