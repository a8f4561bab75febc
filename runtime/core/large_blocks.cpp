// Blocks of 4 MiB and more that operator new gives ask the system for large pages (2 MiB): of a new
// array of 100 MB it then has to provide some fifty pages in place of 25 000, and random access
// rarely waits for the translation of an address. Where the system has no large pages, or does not
// give them to programs that ask (/sys/kernel/mm/transparent_hugepage/enabled is "never"), nothing
// changes. Smaller blocks come from malloc, as usual.
//
// The operators are weak: those that the sources of a program define win. TESS_LARGE_PAGES=OFF leaves
// these out, and so do builds with sanitizers, which have theirs.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <sys/mman.h>

namespace tess::detail {
namespace {

constexpr std::size_t large_page = std::size_t{2} << 20U;
constexpr std::size_t least_size = 2 * large_page;
constexpr std::size_t small_page = 4096;

/// For the small pages from that which the block begins in to the last one that it fills. The system
/// joins them where they fill a large page, so the block takes no more memory than it needs.
void ask_for_large_pages(void* block, std::size_t size) noexcept {
  const std::size_t before = reinterpret_cast<std::uintptr_t>(block) % small_page;
  (void)madvise(static_cast<std::byte*>(block) - before, (before + size) / small_page * small_page,
                MADV_HUGEPAGE);
}

/// Null if there is no memory.
void* find_block(std::size_t size, std::size_t alignment) noexcept {
  const std::size_t used = size;
  const bool is_large = size >= least_size;
  if (is_large) {
    // Linux aligns a new mapping to large pages if it is of whole ones; so it is with what malloc
    // adds, which is less than a small page. What is not used of it takes no memory. (aligned_alloc
    // with 2 MiB would align it, but hardly ever reuses a block that was freed.)
    if (size > SIZE_MAX / 2) return nullptr;
    size = (size + small_page + large_page - 1) / large_page * large_page - small_page;
  }
  void* block = nullptr;
  if (alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__) {
    block = std::malloc(std::max<std::size_t>(size, 1));
  } else if (size <= SIZE_MAX - alignment) {
    const std::size_t whole = (size + alignment - 1) / alignment * alignment;
    block = std::aligned_alloc(alignment, std::max(whole, alignment));
  }
  if (is_large && block != nullptr) ask_for_large_pages(block, used);
  return block;
}

void* allocate(std::size_t size, std::size_t alignment) {
  for (;;) {
    if (void* const block = find_block(size, alignment)) return block;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

}  // namespace
}  // namespace tess::detail

[[gnu::weak]] void* operator new(std::size_t size) {
  return tess::detail::allocate(size, 1);
}
[[gnu::weak]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return tess::detail::allocate(size, static_cast<std::size_t>(alignment));
}
[[gnu::weak]] void operator delete(void* block) noexcept {
  std::free(block);
}
[[gnu::weak]] void operator delete(void* block, std::align_val_t /*alignment*/) noexcept {
  std::free(block);
}
// By the others, which a program may have replaced alone.
[[gnu::weak]] void operator delete(void* block, std::size_t /*size*/) noexcept {
  ::operator delete(block);
}
[[gnu::weak]] void operator delete(void* block, std::size_t /*size*/,
                                   std::align_val_t alignment) noexcept {
  ::operator delete(block, alignment);
}
