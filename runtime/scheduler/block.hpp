// Where messages get their memory: from the pool of the PE that makes them; whoever ends one gives
// it back through the pool of the PE that runs.
#pragma once

#include "runtime/base/pool.hpp"
#include "runtime/scheduler/pe.hpp"

namespace tess {

[[nodiscard]] inline void* allocate_block(Pe& pe, std::size_t n_bytes) {
  return pe.pool().allocate(n_bytes);
}
inline void release_block(void* block, std::size_t /*n_bytes*/) {
  Pe* const pe = current_pe_or_null();
  Pool::release(block, pe != nullptr ? &pe->pool() : nullptr);
}

}  // namespace tess
