#include "runtime/pe/tables/future_table.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>

namespace tess::detail {

FutureTable::Place* FutureTable::place_of(std::uint64_t id) {
  const auto number = static_cast<std::uint32_t>(id);
  if (number < first_ || number - first_ >= places_.size()) return nullptr;
  Place& place = places_[number - first_];
  return place.future != nullptr && place.n_used == id >> 32U ? &place : nullptr;
}

void** FutureTable::known(std::uint64_t id) {
  if (Place* const place = place_of(id); place != nullptr) return &place->future;
  for (auto& [number, future] : before_restart_)
    if (number == id && future != nullptr) return &future;
  return nullptr;
}

std::uint64_t FutureTable::enter(void* future) {
  if (unused_.empty()) {
    unused_.push_back(static_cast<std::uint32_t>(places_.size()));
    places_.emplace_back();
  }
  const std::uint32_t at = unused_.back();
  unused_.pop_back();
  Place& place = places_[at];
  place.future = future;
  return std::uint64_t{place.n_used} << 32U | (first_ + at);
}

void FutureTable::move(std::uint64_t id, void* future) {
  if (void** const at = known(id); at != nullptr) *at = future;
}

void FutureTable::leave(std::uint64_t id) {
  if (Place* const place = place_of(id); place != nullptr) {
    place->future = nullptr;
    if (++place->n_used != 0) unused_.push_back(static_cast<std::uint32_t>(id) - first_);
  } else if (void** const at = known(id); at != nullptr) {
    *at = nullptr;
  }
}

void* FutureTable::find(std::uint64_t id) {
  void** const at = known(id);
  return at == nullptr ? nullptr : *at;
}

void* FutureTable::require(std::uint64_t id) {
  void* const future = find(id);
  TESS_CHECK(future != nullptr || static_cast<std::uint32_t>(id) >= first_,
             "a callback to a future of the run before the restart was called: make the future "
             "again after the restart, and send its new callback()");
  TESS_CHECK(
      future != nullptr,
      "a result came for a future that has its result already or was destroyed: give it one, "
      "and keep the future until that is there; an element that keeps one does not migrate before");
  return future;
}

void FutureTable::begin_behind(std::uint32_t n_places) {
  for (std::uint32_t at = 0; at < places_.size(); ++at)
    if (const Place& place = places_[at]; place.future != nullptr)
      before_restart_.emplace_back(std::uint64_t{place.n_used} << 32U | (first_ + at),
                                   place.future);
  first_ = std::max(n_places, this->n_places());
  places_.assign(1, {});
  unused_.clear();
}

}  // namespace tess::detail
