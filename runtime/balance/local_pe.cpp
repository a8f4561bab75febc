#include "runtime/balance/local_pe.hpp"

#include "runtime/balance/metrics.hpp"

#include <algorithm>
#include <limits>

namespace tess::balance {

std::int64_t PeSummary::needs_bytes(const Item& item) const {
  const bool is_new = item.block != no_block && !std::ranges::binary_search(blocks, item.block);
  return item.memory_bytes + (is_new ? item.block_bytes : 0) +
         std::max(std::int64_t{0}, item.working_bytes - working_bytes);
}

void PeSummary::occupy(const Item& item) {
  room_bytes -= needs_bytes(item);
  working_bytes = std::max(working_bytes, item.working_bytes);
  if (item.block == no_block) return;
  const auto at = std::ranges::lower_bound(blocks, item.block);
  if (at == blocks.end() || *at != item.block) blocks.insert(at, item.block);
}

void LocalPe::hold(const Item& item, bool migratable) {
  now_.work += item.load;
  now_.occupy(item);
  if (item.block != no_block) ++users_[item.block];
  if (item.working_bytes > 0) ++working_[item.working_bytes];
  if (migratable && item.load > 0) items_.insert(item);
}

void LocalPe::give(const Item& item) {
  now_.work -= item.load;
  now_.room_bytes += item.memory_bytes;
  if (item.block != no_block && --users_[item.block] == 0) {
    users_.erase(item.block);
    now_.blocks.erase(std::ranges::lower_bound(now_.blocks, item.block));
    now_.room_bytes += item.block_bytes;
  }
  if (item.working_bytes > 0 && --working_[item.working_bytes] == 0) {
    working_.erase(item.working_bytes);
    const std::int64_t most = working_.empty() ? 0 : working_.rbegin()->first;
    now_.room_bytes += now_.working_bytes - most;
    now_.working_bytes = most;
  }
  items_.erase(item);
}

std::optional<Item> LocalPe::offer(const PeSummary& other, double wanted) const {
  const auto above = items_.upper_bound({wanted, std::numeric_limits<std::size_t>::max(), 0});
  for (auto i = above; i != items_.begin();)
    if (--i; other.needs_bytes(*i) <= other.room_bytes) return *i;
  if (above != items_.end()) return *above;
  return std::nullopt;
}

std::optional<std::vector<Item>> LocalPe::change_for(const Item& item, double wanted,
                                                     const PeSummary& giver) const {
  std::vector<Item> change;
  double net = item.load;
  std::int64_t room_here = now_.room_bytes;
  PeSummary there = giver;
  there.room_bytes += item.memory_bytes;
  const auto fits_there = [&](const Item& one) {
    return there.needs_bytes(one) <= there.room_bytes;
  };
  while (net > wanted) {
    // The next element that is neither given yet nor larger than the excess.
    const double most = net - wanted;
    auto i = items_.upper_bound({most, std::numeric_limits<std::size_t>::max(), 0});
    if (!change.empty() && most >= change.back().load) i = items_.find(change.back());
    while (i != items_.begin() && !fits_there(*--i)) {
    }
    if (i == items_.end() || i->load > most || !fits_there(*i)) break;
    if (!change.empty() && !(*i < change.back())) break;
    change.push_back(*i);
    net -= i->load;
    room_here += i->memory_bytes;
    there.occupy(*i);
  }
  if (now_.needs_bytes(item) > room_here || now_.time(net) >= (1 - least_gain) * giver.time() ||
      !(net > 0))
    return std::nullopt;
  return change;
}

void trade(LocalPe& giver, LocalPe& taker, const Item& item, const std::vector<Item>& change) {
  giver.give(item);
  for (const Item& back : change) {
    taker.give(back);
    giver.receive(back);
  }
  taker.receive(item);
}

std::int64_t room_of(std::uint64_t memory_limit_bytes) {
  constexpr std::int64_t unlimited = std::numeric_limits<std::int64_t>::max() / 2;
  return memory_limit_bytes == 0 || memory_limit_bytes > unlimited
             ? unlimited
             : static_cast<std::int64_t>(memory_limit_bytes);
}

std::vector<LocalPe> local_pes(const Snapshot& s) {
  std::vector<LocalPe> result;
  for (std::size_t p = 0; p < s.pes.size(); ++p) {
    const std::int64_t room = room_of(s.pes.memory_limit_bytes[p]);
    result.emplace_back(PeSummary{0, s.pes.background[p], s.pes.speed[p],
                                  room - static_cast<std::int64_t>(s.pes.working_bytes_of(p))});
  }
  const Elements& e = s.elements;
  for (std::size_t i = 0; i < e.size(); ++i) {
    Item item{e.load[i].seconds(), i, static_cast<std::int64_t>(e.memory_bytes[i]),
              static_cast<std::int64_t>(e.working_bytes_of(i)), e.block_of(i)};
    if (item.block != no_block)
      item.block_bytes = static_cast<std::int64_t>(s.blocks[item.block].bytes);
    result[slot(e.pe[i])].hold(item, e.migratable[i] != 0);
  }
  return result;
}

Assignment collect(const Snapshot& s, const std::vector<LocalPe>& pes) {
  Assignment result = s.elements.pe;
  for (std::size_t p = 0; p < pes.size(); ++p)
    for (const Item& item : pes[p].items()) result[item.element] = pe_at(p);
  return result;
}

}  // namespace tess::balance
