#include "runtime/balance/unknown_loads.hpp"

namespace tess::balance {

std::size_t n_known_loads(const Snapshot& s) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < s.elements.size(); ++i) n += s.elements.knows_load(i) ? 1U : 0U;
  return n;
}

void assume_mean_loads(Snapshot& s) {
  const std::size_t n_known = n_known_loads(s);
  double sum = 0;
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (s.elements.knows_load(i)) sum += s.elements.load[i];
  const double mean = n_known == 0 ? 0 : sum / static_cast<double>(n_known);
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (!s.elements.knows_load(i)) s.elements.load[i] = mean;
}

Snapshot with_unknown_pinned(Snapshot s) {
  assume_mean_loads(s);
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (!s.elements.knows_load(i)) s.elements.migratable[i] = 0;
  return s;
}

}  // namespace tess::balance
