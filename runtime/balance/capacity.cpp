#include "runtime/balance/capacity.hpp"

#include <algorithm>
#include <numeric>

namespace tess::balance {
namespace {

double migrating_load(const Snapshot& s) {
  double sum = 0;
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (s.elements.migratable[i]) sum += s.elements.load[i].seconds();
  return sum;
}

}  // namespace

std::vector<double> capacities(const Snapshot& s) {
  const std::size_t n = s.pes.size();
  const double to_place = migrating_load(s);
  if (to_place == 0) return std::vector<double>(n, 1.0);
  std::vector<double> busy = s.pes.background;
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (const std::size_t p = slot(s.elements.pe[i]); !s.elements.migratable[i])
      busy[p] += s.elements.load[i].seconds() / s.pes.speed[p];

  // Fills PEs in order of their time, until the level is below the next PE's time.
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](auto a, auto b) { return busy[a] < busy[b]; });
  double speed = 0, work = to_place, level = 0;
  for (const std::size_t p : order) {
    if (speed > 0 && level <= busy[p]) break;
    speed += s.pes.speed[p];
    work += busy[p] * s.pes.speed[p];
    level = work / speed;
  }
  std::vector<double> result(n);
  for (std::size_t p = 0; p < n; ++p) result[p] = std::max(0.0, level - busy[p]) * s.pes.speed[p];
  return result;
}

std::vector<double> weights(const Snapshot& s) {
  if (migrating_load(s) > 0) {
    std::vector<double> result;
    for (const Load load : s.elements.load) result.push_back(load.seconds());
    return result;
  }
  const auto n_migrating =
      std::ranges::count_if(s.elements.migratable, [](auto m) { return m != 0; });
  const double share = static_cast<double>(s.pes.size()) /
                       static_cast<double>(std::max<std::ptrdiff_t>(1, n_migrating));
  return std::vector<double>(s.elements.size(), share);
}

}  // namespace tess::balance
