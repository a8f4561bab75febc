#include "runtime/pe/block.hpp"

namespace tess::detail {

void* allocate_received(Pe& pe, std::size_t n_bytes) {
  return allocate_block(pe, n_bytes);
}

void release_message(Envelope* message) {
  release_block(message, 0);
}

}  // namespace tess::detail
