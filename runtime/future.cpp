#include "runtime/future.hpp"

#include "runtime/core/check.hpp"

namespace tess::detail {

std::string FutureBase::text_of(std::string_view value) {
  return text("a future of ", value);
}

FutureBase::Where FutureBase::where(std::span<const std::byte> name) {
  return from_bytes<Where>(name);
}
std::string FutureBase::describe(std::span<const std::byte> name) {
  const Where to = where(name);
  return text("future ", to.id, " of ", to.pe);
}

Pe& FutureBase::sends_to(const Where& to) {
  Pe& here = current_pe();
  if (to.pe.value >= here.n_pes()) (void)here.futures().require(0);
  return here;
}

FutureBase::Slot& FutureBase::find(Pe& pe, std::uint64_t id, std::string_view value) {
  auto* const slot = static_cast<Slot*>(pe.futures().require(id));
  TESS_CHECK(!slot->given, text_of(value), " was given two results: it takes one");
  return *slot;
}

void FutureBase::given(Pe& pe, Slot& slot) {
  slot.given = true;
  Waiter* const waiter = slot.waiting;
  pe.futures().leave(slot.id);
  slot.id.store(0, std::memory_order_release);  // read by is_expected()
  if (waiter != nullptr) waiter->wake();
}

FutureBase::Where FutureBase::name() const {
  TESS_CHECK(!moved_, "a future that was moved from has no callback: use the one it moved to");
  enter();
  return {pe_->id(), slot_->id.load()};
}

void FutureBase::wait(Waiter& waiter) {
  TESS_CHECK(!moved_, "a future that was moved from is awaited: await the one it moved to");
  TESS_CHECK(!is_awaited(), "two coroutines await one future");
  enter();
  slot_->waiting = &waiter;
}

void FutureBase::take_result(std::string_view value) {
  withdraw();
  TESS_CHECK(!std::exchange(taken_, true), text_of(value),
             " is awaited again: the first co_await took its result, so keep that");
}

void FutureBase::enter() const {
  if (slot_ == nullptr) slot_ = make_();
  if (!is_expected()) {
    pe_ = &current_pe();
    slot_->id = pe_->futures().enter(slot_.get());
  }
  require_here();
}

void FutureBase::require_here() const {
  TESS_CHECK(pe_ == &current_pe(), "a future of ", pe_->id(), " is used on ", current_pe().id(),
             ": its element has migrated before its result was there; make it a local variable "
             "of the coroutine that awaits it, or migrate after that");
}

void FutureBase::leave() {
  if (!is_expected()) return;
  if (const Pe* const here = current_pe_or_null(); here != pe_) [[unlikely]] {
    if (here == nullptr || here->stopped()) return;  // the run is over
    require_here();
  }
  pe_->futures().leave(slot_->id);
}

void FutureBase::take(FutureBase& other) {
  TESS_CHECK(!other.is_awaited(), "a future is moved while a coroutine waits for it");
  TESS_CHECK(!other.is_expected() || &current_pe() == other.pe_, "a future of ", other.pe_->id(),
             " is moved on ", current_pe().id(), ": send its callback() instead");
  moved_ = std::exchange(other.moved_, true);
  pe_ = other.pe_;
  slot_ = std::move(other.slot_);
  taken_ = other.taken_;
}

void FutureBase::replace(FutureBase& other) {
  if (this == &other) return;
  TESS_CHECK(!is_awaited(), "a future is overwritten while a coroutine waits for it");
  leave();
  take(other);
}

}  // namespace tess::detail
