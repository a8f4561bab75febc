#include "runtime/balance/unknown_loads.hpp"

#include "runtime/core/error.hpp"

namespace tess::balance {

void Load::refuse(double seconds) {
  fail(ErrorCode::bad_value, "balance: a load of ", seconds,
       " seconds; give 0 or more, or Load::unknown()");
}

void Load::refuse_unknown() {
  fail(ErrorCode::bad_value,
       "balance strategy: takes an unknown load for a number; ask is_known(), or seconds_or()");
}

std::size_t n_known_loads(const Snapshot& s) {
  std::size_t n = 0;
  for (const Load load : s.elements.load) n += load.is_known() ? 1U : 0U;
  return n;
}

double mean_load(const Snapshot& s) {
  const std::size_t n_known = n_known_loads(s);
  double sum = 0;
  for (const Load load : s.elements.load) sum += load.seconds_or(0);
  return n_known == 0 ? 0 : sum / static_cast<double>(n_known);
}

Snapshot with_unknown_pinned(Snapshot s) {
  const double mean = mean_load(s);
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    if (s.elements.load[i].is_known()) continue;
    s.elements.load[i] = mean;
    s.elements.migratable[i] = 0;
  }
  return s;
}

}  // namespace tess::balance
