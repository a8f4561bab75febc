#include "runtime/balance/strategies/greedy.hpp"

#include "runtime/balance/soonest.hpp"

#include <algorithm>
#include <functional>

namespace tess::balance {

std::vector<std::size_t> heaviest_first(const Snapshot& s) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (s.elements.migratable[i]) order.push_back(i);
  const auto load = [&](std::size_t i) { return s.elements.load[i].seconds(); };
  std::ranges::stable_sort(order, std::greater{}, load);
  return order;
}

Assignment place_soonest(const Snapshot& s, const std::vector<std::size_t>& elements) {
  Assignment result = s.elements.pe;
  std::vector<bool> placed(result.size(), true);
  for (const std::size_t i : elements) placed[i] = false;
  Loads loads(s);
  for (std::size_t i = 0; i < result.size(); ++i)
    if (placed[i]) loads.put(i, slot(result[i]));
  Soonest soonest(s, loads);
  for (const std::size_t i : elements) {
    const std::size_t from = slot(result[i]);
    const std::size_t to = soonest.best(i, from);
    loads.put(i, to);
    loads.move_memory(i, from, to);
    soonest.update(to);
    result[i] = pe_at(to);
  }
  return result;
}

Assignment greedy(const Snapshot& s) {
  return place_soonest(s, heaviest_first(s));
}

}  // namespace tess::balance
