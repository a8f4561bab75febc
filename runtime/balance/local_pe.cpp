#include "runtime/balance/local_pe.hpp"

#include <algorithm>
#include <limits>

namespace tess::balance {

void LocalPe::hold(const Item& item, bool migratable) {
  now_.work += item.load;
  now_.room_bytes -= std::min(now_.room_bytes, item.memory_bytes);
  if (migratable && item.load > 0) items_.insert(item);
}

void LocalPe::give(const Item& item) {
  now_.work -= item.load;
  now_.room_bytes += item.memory_bytes;
  items_.erase(item);
}

bool LocalPe::receive(const Item& item) {
  if (item.memory_bytes > now_.room_bytes) return false;
  hold(item, true);
  return true;
}

std::optional<Item> LocalPe::item_for(const PeSummary& other, double wanted) const {
  const auto good = [&](const Item& item) {
    return item.memory_bytes <= other.room_bytes && other.time(item.load) < now_.time();
  };
  const auto above = items_.upper_bound({wanted, std::numeric_limits<std::size_t>::max(), 0});
  for (auto i = above; i != items_.begin();)
    if (good(*--i)) return *i;
  for (auto i = above; i != items_.end() && other.time(i->load) < now_.time(); ++i)
    if (good(*i)) return *i;
  return std::nullopt;
}

std::vector<LocalPe> local_pes(const Snapshot& s) {
  std::vector<LocalPe> result;
  for (std::size_t p = 0; p < s.pes.size(); ++p) {
    const std::uint64_t limit = s.pes.memory_limit_bytes[p];
    // Without a limit half of all numbers, so that what is given back never wraps around.
    const std::uint64_t room = limit == 0 ? std::numeric_limits<std::uint64_t>::max() / 2 : limit;
    result.emplace_back(PeSummary{0, s.pes.background[p], s.pes.speed[p], room});
  }
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    result[slot(s.elements.pe[i])].hold({s.elements.load[i], i, s.elements.memory_bytes[i]},
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
