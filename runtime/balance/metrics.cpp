#include "runtime/balance/metrics.hpp"

#include "runtime/balance/loads.hpp"

#include <algorithm>
#include <numeric>

namespace tess::balance {

double average_time(const Snapshot& s) {
  double work = std::accumulate(s.elements.load.begin(), s.elements.load.end(), 0.0);
  double speed = 0;
  for (std::size_t p = 0; p < s.pes.size(); ++p) {
    work += s.pes.background[p] * s.pes.speed[p];
    speed += s.pes.speed[p];
  }
  return work / speed;
}

Metrics measure(const Snapshot& s, const Assignment& assignment) {
  Metrics m;
  Loads loads(s);
  for (std::size_t i = 0; i < assignment.size(); ++i) {
    loads.put(i, slot(assignment[i]));
    if (assignment[i] == s.elements.pe[i]) continue;
    ++m.n_moves;
    m.moved_bytes += s.elements.size_bytes[i];
  }
  for (const Edge& e : s.edges)
    if (assignment[e.from] != assignment[e.to]) m.external_bytes += e.bytes;
  double slowest = 0;
  for (std::size_t p = 0; p < s.pes.size(); ++p) slowest = std::max(slowest, loads.time(p));
  if (const double average = average_time(s); average > 0) m.max_over_average = slowest / average;
  return m;
}

}  // namespace tess::balance
