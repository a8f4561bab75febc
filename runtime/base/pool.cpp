#include "runtime/base/pool.hpp"

#include <algorithm>

namespace tess::detail {

void* Pool::allocate_unpooled(std::size_t bytes) {
  // At least the size of a Link: release() writes one before it knows the block's destination.
  void* const memory = ::operator new(sizeof(Header) + std::max(bytes, sizeof(Link)));
  return ::new (memory) Header{nullptr, 0} + 1;
}

void* Pool::refill(std::size_t size_class) {
  take_returned();
  if (free_[size_class] == nullptr) carve(size_class);
  Link* const link = free_[size_class];
  free_[size_class] = link->next;
  return link;
}

void Pool::take_returned() noexcept {
  for (Link* link = returned_.take_all_reversed(); link != nullptr;) {
    Link* const next = link->next;
    Link*& list = free_[header_of(link)->size_class];
    link->next = list;
    list = link;
    link = next;
  }
}

void Pool::carve(std::size_t size_class) {
  const std::size_t block_bytes = (size_class + 1) * granule;
  const std::size_t slab_bytes =
      std::min(first_slab_bytes << n_slabs_[size_class], last_slab_bytes);
  if (slab_bytes < last_slab_bytes) ++n_slabs_[size_class];
  const std::size_t n = slab_bytes / block_bytes;
  slabs_.emplace_back(
      static_cast<std::byte*>(::operator new(n* block_bytes, std::align_val_t{granule})));
  held_bytes_ += n * block_bytes;
  for (std::size_t i = n; i-- > 0;) {  // backwards, so that the list is ascending in memory
    auto* const header = ::new (slabs_.back().get() + i * block_bytes) Header{this, size_class};
    free_[size_class] = ::new (header + 1) Link{free_[size_class]};
  }
}

void Pool::give_back(Pool* owner, Link* link) noexcept {
  const auto address = reinterpret_cast<std::uintptr_t>(owner);
  Batch& batch = batches_[(address * 0x9e3779b97f4a7c15U) >> 61U];
  if (batch.owner != owner) {
    send(batch);
    batch.owner = owner;
  }
  link->next = batch.first;
  if (batch.first == nullptr) batch.last = link;
  batch.first = link;
  if (++batch.n == batch_most) send(batch);
}

void Pool::flush() noexcept {
  for (Link*& hot : borrowed_) {
    if (hot == nullptr) continue;
    give_back(header_of(hot)->owner, hot);
    hot = nullptr;
  }
  for (Batch& batch : batches_) send(batch);
}

void Pool::send(Batch& batch) noexcept {
  if (batch.n == 0) return;
  batch.owner->returned_.push_chain(batch.first, batch.last);
  batch = {};
}

}  // namespace tess::detail
