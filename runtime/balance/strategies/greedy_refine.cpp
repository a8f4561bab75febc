#include "runtime/balance/strategies/greedy_refine.hpp"

#include "runtime/balance/loads.hpp"
#include "runtime/balance/metrics.hpp"
#include "runtime/balance/strategies/greedy.hpp"
#include "runtime/balance/strategies/refine.hpp"

#include <algorithm>

namespace tess::balance {
namespace {

/// Elements that leave their PEs, heaviest first: from each PE repeatedly the largest that fits
/// into its excess, and finally the smallest that exceeds the rest of the excess.
std::vector<std::size_t> shed(const Snapshot& s, double limit) {
  const Loads now = Loads::present(s);
  std::vector<double> excess;
  for (std::size_t p = 0; p < s.pes.size(); ++p)
    excess.push_back((now.time(p) - limit) * s.pes.speed[p]);
  const auto load = [&](std::size_t i) { return s.elements.load[i].seconds(); };
  std::vector<bool> leaves(s.elements.size(), false);
  const std::vector<std::size_t> order = heaviest_first(s);
  const auto leave = [&](std::size_t i) {
    leaves[i] = true;
    excess[slot(s.elements.pe[i])] -= load(i);
  };
  for (const std::size_t i : order)
    if (load(i) > 0 && load(i) <= excess[slot(s.elements.pe[i])]) leave(i);
  for (auto i = order.rbegin(); i != order.rend(); ++i) {
    const double rest = excess[slot(s.elements.pe[*i])];
    if (!leaves[*i] && rest > 0 && load(*i) >= rest) leave(*i);
  }
  std::vector<std::size_t> result;
  std::ranges::copy_if(order, std::back_inserter(result), [&](auto i) { return leaves[i]; });
  return result;
}

}  // namespace

Assignment greedy_refine(const Snapshot& s, double tolerance) {
  Assignment all = greedy(s);
  const double best = std::max(1.0, measure(s, all).max_over_average);
  // Where whole elements cannot do better, noise of the loads moves none.
  if (measure(s, s.elements.pe).max_over_average <= tolerance * best) return s.elements.pe;
  const double limit = tolerance * average_time(s);
  Assignment few = refine_from(s, place_soonest(s, shed(s, limit)), tolerance);
  return measure(s, few).max_over_average <= tolerance * best ? few : all;
}

}  // namespace tess::balance
