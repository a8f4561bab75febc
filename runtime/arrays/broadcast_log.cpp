#include "runtime/arrays/broadcast_log.hpp"

#include "runtime/base/spanning_tree.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>

namespace tess::detail {
namespace {

// Settled broadcasts are reported to the root in portions of so many or so many bytes, so that a
// small broadcast costs no reply.
constexpr std::uint64_t portion = 16;
constexpr std::uint64_t portion_bytes = 1 << 20;

// Elements keep the number of a broadcast in 32 bits.
constexpr std::uint64_t most_broadcasts = ~std::uint32_t{0};

}  // namespace

struct BroadcastLog::Tables {
  struct Early {
    NumberedCall call;
    Counted counted;
  };
  std::deque<NumberedCall> copies;       // first_kept_ … applied_
  std::deque<Counted> unsettled;         // those of settled_ + 1 … applied_
  std::map<std::uint64_t, Early> early;  // arrived before their turn
  std::map<std::uint64_t, std::uint64_t> in_flight;
  std::map<PeId, std::uint64_t> settled_by;  // at the root
};

BroadcastLog::BroadcastLog(BroadcastHost& host, PeId here, PeId root, std::int32_t n_pes)
    : host_(host),
      here_(here),
      root_(root),
      n_pes_(n_pes),
      children_(SpanningTree(here, root, n_pes).children()),
      tables_(std::make_unique<Tables>()) {}

BroadcastLog::~BroadcastLog() = default;

void BroadcastLog::left(std::uint64_t seen) {
  ++tables_->in_flight[seen];
}

std::size_t BroadcastLog::n_kept() const {
  return tables_->copies.size();
}

void BroadcastLog::on_start(NumberedCall&& call, Counted counted) {
  call.number = ++last_number_;
  TESS_CHECK(last_number_ <= most_broadcasts, "a collection has had ", last_number_ - 1,
             " broadcasts, which is the limit: create another one");
  on_call(std::move(call), std::move(counted));
}

void BroadcastLog::on_call(NumberedCall&& call, Counted counted) {
  for (const PeId child : children_) host_.send(child, call);
  host_.flush();  // other processes do not wait for the local elements
  const std::uint64_t number = call.number;
  tables_->early.emplace(number, Tables::Early{std::move(call), std::move(counted)});
  while (!tables_->early.empty() && tables_->early.begin()->first == applied_ + 1) {
    Tables::Early& next = tables_->early.begin()->second;
    tables_->copies.push_back(std::move(next.call));
    tables_->unsettled.push_back(std::move(next.counted));
    tables_->early.erase(tables_->early.begin());
    ++applied_;
    const NumberedCall current = tables_->copies.back();
    host_.apply(current);
    settle();
  }
}

void BroadcastLog::arrived(std::uint64_t seen) {
  const auto at = tables_->in_flight.find(seen);
  if (--at->second == 0) tables_->in_flight.erase(at);
  settle();
}

void BroadcastLog::settle() {
  const std::uint64_t now =
      tables_->in_flight.empty() ? applied_ : std::min(applied_, tables_->in_flight.begin()->first);
  while (settled_ < now) {
    ++settled_;
    untold_bytes_ += tables_->copies[settled_ - first_kept_].n_bytes;
    tables_->unsettled.pop_front();
  }
  if (settled_ - told_ < portion && untold_bytes_ < portion_bytes) return;
  told_ = settled_;
  untold_bytes_ = 0;
  host_.send(root_, BroadcastSettled{here_, settled_});
}

void BroadcastLog::end() {
  settled_ = applied_;
  tables_->unsettled.clear();
  tables_->copies.clear();
  tables_->early.clear();
  tables_->in_flight.clear();
}

std::vector<NumberedCall> BroadcastLog::missed(std::uint64_t seen) const {
  std::vector<NumberedCall> calls;
  for (std::uint64_t number = seen + 1; number <= applied_; ++number)
    calls.push_back(tables_->copies.at(number - first_kept_));
  return calls;
}

void BroadcastLog::on_settled(const BroadcastSettled& settled) {
  std::uint64_t& known = tables_->settled_by[settled.from];
  known = std::max(known, settled.number);
  if (tables_->settled_by.size() < static_cast<std::size_t>(n_pes_)) return;
  std::uint64_t all = known;
  for (const auto& [pe, number] : tables_->settled_by) all = std::min(all, number);
  if (all == dropped_) return;
  dropped_ = all;
  for (std::int32_t pe = 0; pe < n_pes_; ++pe) host_.send(PeId{pe}, BroadcastDrop{all});
}

void BroadcastLog::on_drop(const BroadcastDrop& drop) {
  while (first_kept_ <= drop.number) {
    tables_->copies.pop_front();
    ++first_kept_;
  }
}

}  // namespace tess::detail
