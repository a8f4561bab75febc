#include "runtime/base/huge_pages.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace tess::detail {

void* allocate_huge_pages(std::size_t n_bytes) {
  void* const memory = ::operator new(n_bytes, std::align_val_t{huge_page_bytes});
#if defined(__linux__)
  // Only advice: the memory is usable if it is refused.
  (void)madvise(memory, n_bytes, MADV_HUGEPAGE);
#endif
  return memory;
}

void free_huge_pages(void* memory) noexcept {
  ::operator delete(memory, std::align_val_t{huge_page_bytes});
}

}  // namespace tess::detail
