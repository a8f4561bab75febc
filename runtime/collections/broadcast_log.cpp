#include "runtime/collections/broadcast_log.hpp"

#include "runtime/base/spanning_tree.hpp"

#include <algorithm>

namespace tess::detail {
namespace {

// Settled broadcasts are reported to the root in portions, so that a broadcast costs no reply.
constexpr std::uint64_t portion = 16;

}  // namespace

BroadcastLog::BroadcastLog(BroadcastHost& host, Completion& completion, PeId here, PeId root,
                           std::int32_t n_pes)
    : host_(host),
      completion_(completion),
      here_(here),
      root_(root),
      n_pes_(n_pes),
      children_(SpanningTree(here, root, n_pes).children()) {}

void BroadcastLog::on_start(NumberedCall&& call) {
  call.number = ++last_number_;
  on_call(std::move(call));
}

void BroadcastLog::on_call(NumberedCall&& call) {
  for (const PeId child : children_) {
    completion_.sent(call.epoch);
    host_.send(child, call);
  }
  host_.flush();  // other processes do not wait for the local elements
  early_.emplace(call.number, std::move(call));
  while (!early_.empty() && early_.begin()->first == applied_ + 1) {
    copies_.push_back(std::move(early_.begin()->second));
    early_.erase(early_.begin());
    ++applied_;
    const NumberedCall current = copies_.back();
    host_.apply(current);
    settle();
  }
}

void BroadcastLog::arrived(std::uint64_t seen) {
  const auto at = in_flight_.find(seen);
  if (--at->second == 0) in_flight_.erase(at);
  settle();
}

void BroadcastLog::settle() {
  const std::uint64_t now =
      in_flight_.empty() ? applied_ : std::min(applied_, in_flight_.begin()->first);
  while (settled_ < now) {
    ++settled_;
    completion_.processed(copies_[settled_ - first_kept_].epoch);
  }
  if (settled_ - told_ < portion) return;
  told_ = settled_;
  host_.send(root_, BroadcastSettled{here_, settled_});
}

void BroadcastLog::end() {
  while (settled_ < applied_) {
    ++settled_;
    completion_.processed(copies_[settled_ - first_kept_].epoch);
  }
  for (const auto& [number, call] : early_) completion_.processed(call.epoch);
  copies_.clear();
  early_.clear();
  in_flight_.clear();
}

std::vector<NumberedCall> BroadcastLog::missed(std::uint64_t seen) const {
  std::vector<NumberedCall> calls;
  for (std::uint64_t number = seen + 1; number <= applied_; ++number)
    calls.push_back(copies_.at(number - first_kept_));
  return calls;
}

void BroadcastLog::on_settled(const BroadcastSettled& settled) {
  std::uint64_t& known = settled_by_[settled.from];
  known = std::max(known, settled.number);
  if (settled_by_.size() < static_cast<std::size_t>(n_pes_)) return;
  std::uint64_t all = known;
  for (const auto& [pe, number] : settled_by_) all = std::min(all, number);
  if (all == dropped_) return;
  dropped_ = all;
  for (std::int32_t pe = 0; pe < n_pes_; ++pe) host_.send(PeId{pe}, BroadcastDrop{all});
}

void BroadcastLog::on_drop(const BroadcastDrop& drop) {
  while (first_kept_ <= drop.number) {
    copies_.pop_front();
    ++first_kept_;
  }
}

}  // namespace tess::detail
