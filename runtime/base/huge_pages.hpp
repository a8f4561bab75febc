// An allocator for large tables with random access. For sizes of a few MiB and above it requests
// huge pages from the system, so that a lookup does not also miss the address translation cache.
#pragma once

#include <cstddef>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace tess::detail {

template <class T>
struct HugePageAllocator {
  using value_type = T;
  static constexpr std::size_t page_bytes = std::size_t{2} << 20U;

  HugePageAllocator() = default;
  // Containers convert allocators implicitly.
  template <class Other>
  // NOLINTNEXTLINE(google-explicit-constructor)
  HugePageAllocator(const HugePageAllocator<Other>& /*other*/) {}

  [[nodiscard]] T* allocate(std::size_t n) {
    const std::size_t n_bytes = n * sizeof(T);
    if (n_bytes < 2 * page_bytes) return static_cast<T*>(::operator new(n_bytes));
    void* const memory = ::operator new(n_bytes, std::align_val_t{page_bytes});
#if defined(__linux__)
    (void)madvise(memory, n_bytes,
                  MADV_HUGEPAGE);  // only advice: the memory is usable if it is refused
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* at, std::size_t n) {
    if (n * sizeof(T) < 2 * page_bytes) {
      ::operator delete(at);
    } else {
      ::operator delete(at, std::align_val_t{page_bytes});
    }
  }
  friend bool operator==(const HugePageAllocator&, const HugePageAllocator&) { return true; }
};

}  // namespace tess::detail
