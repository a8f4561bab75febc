#include "runtime/balance/local_pe.hpp"

#include <limits>

namespace tess::balance {

void LocalPe::hold(const Item& item, bool migratable) {
  now_.work += item.load;
  now_.room_bytes -= item.memory_bytes;
  if (migratable && item.load > 0) items_.insert(item);
}

void LocalPe::give(const Item& item) {
  now_.work -= item.load;
  now_.room_bytes += item.memory_bytes;
  items_.erase(item);
}

std::optional<Item> LocalPe::offer(const PeSummary& other, double wanted) const {
  const auto above = items_.upper_bound({wanted, std::numeric_limits<std::size_t>::max(), 0});
  for (auto i = above; i != items_.begin();)
    if ((--i)->memory_bytes <= other.room_bytes) return *i;
  if (above != items_.end()) return *above;
  return std::nullopt;
}

std::optional<std::vector<Item>> LocalPe::change_for(const Item& item, double wanted,
                                                     const PeSummary& giver) const {
  std::vector<Item> change;
  double net = item.load;
  std::int64_t room_here = now_.room_bytes;
  std::int64_t room_there = giver.room_bytes + item.memory_bytes;
  while (net > wanted) {
    // The next element that is neither given yet nor larger than the excess.
    const double most = net - wanted;
    auto i = items_.upper_bound({most, std::numeric_limits<std::size_t>::max(), 0});
    if (!change.empty() && most >= change.back().load) i = items_.find(change.back());
    while (i != items_.begin() && (--i)->memory_bytes > room_there) {
    }
    if (i == items_.end() || i->load > most || i->memory_bytes > room_there) break;
    if (!change.empty() && !(*i < change.back())) break;
    change.push_back(*i);
    net -= i->load;
    room_here += i->memory_bytes;
    room_there -= i->memory_bytes;
  }
  if (item.memory_bytes > room_here || now_.time(net) >= giver.time() || !(net > 0))
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

std::vector<LocalPe> local_pes(const Snapshot& s) {
  std::vector<LocalPe> result;
  for (std::size_t p = 0; p < s.pes.size(); ++p) {
    const auto limit = static_cast<std::int64_t>(s.pes.memory_limit_bytes[p]);
    const std::int64_t room = limit == 0 ? std::numeric_limits<std::int64_t>::max() / 2 : limit;
    result.emplace_back(PeSummary{0, s.pes.background[p], s.pes.speed[p], room});
  }
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    result[slot(s.elements.pe[i])].hold(
        {s.elements.load[i], i, static_cast<std::int64_t>(s.elements.memory_bytes[i])},
        s.elements.migratable[i] != 0);
  return result;
}

Assignment collect(const Snapshot& s, const std::vector<LocalPe>& pes) {
  Assignment result = s.elements.pe;
  for (std::size_t p = 0; p < pes.size(); ++p)
    for (const Item& item : pes[p].items()) result[item.element] = pe_at(p);
  return result;
}

}  // namespace tess::balance
