// Where messages get their memory.
#pragma once

#include <cstddef>
#include <new>

namespace tess {

class Pe;

[[nodiscard]] inline void* allocate_block(Pe& /*pe*/, std::size_t n_bytes) {
  return ::operator new(n_bytes);
}
inline void release_block(void* block, std::size_t n_bytes) {
  ::operator delete(block, n_bytes);
}

}  // namespace tess
