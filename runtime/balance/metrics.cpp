#include "runtime/balance/metrics.hpp"

#include "runtime/balance/unknown_loads.hpp"
#include "runtime/core/text.hpp"

#include <algorithm>

namespace tess::balance {

double average_time(const Snapshot& s) {
  const double assumed = mean_load(s);
  double work = 0, speed = 0;
  for (const Load load : s.elements.load) work += load.seconds_or(assumed);
  for (std::size_t p = 0; p < s.pes.size(); ++p) {
    work += s.pes.background[p] * s.pes.speed[p];
    speed += s.pes.speed[p];
  }
  return work / speed;
}

Metrics measure(const Snapshot& s, const Assignment& assignment) {
  Metrics m;
  const double assumed = mean_load(s);
  std::vector<double> work(s.pes.size(), 0.0);
  for (std::size_t i = 0; i < assignment.size(); ++i) {
    work[slot(assignment[i])] += s.elements.load[i].seconds_or(assumed);
    if (assignment[i] == s.elements.pe[i]) continue;
    ++m.n_moves;
    m.moved_bytes += s.elements.size_bytes[i];
  }
  for (const Edge& e : s.edges)
    if (assignment[e.from] != assignment[e.to]) m.external_bytes += e.bytes;
  double slowest = 0;
  for (std::size_t p = 0; p < s.pes.size(); ++p)
    slowest = std::max(slowest, s.pes.background[p] + work[p] / s.pes.speed[p]);
  if (const double average = average_time(s); average > 0) m.max_over_average = slowest / average;
  return m;
}

std::vector<std::vector<std::uint64_t>> bytes_between(const Snapshot& s,
                                                      const Assignment& assignment) {
  std::vector<std::vector<std::uint64_t>> bytes(s.pes.size(),
                                                std::vector<std::uint64_t>(s.pes.size(), 0));
  for (const Edge& e : s.edges) bytes[slot(assignment[e.from])][slot(assignment[e.to])] += e.bytes;
  return bytes;
}

std::vector<PeLoad> loads_of_pes(const Snapshot& s, const Assignment& assignment) {
  const double assumed = mean_load(s);
  std::vector<PeLoad> pes(s.pes.size());
  for (std::size_t p = 0; p < pes.size(); ++p) {
    pes[p].busy = s.pes.background[p];
    pes[p].speed = s.pes.speed[p];
  }
  for (std::size_t i = 0; i < assignment.size(); ++i) {
    PeLoad& pe = pes[slot(assignment[i])];
    const double seconds = s.elements.load[i].seconds_or(assumed) / pe.speed;
    pe.busy += seconds;
    if (seconds <= pe.largest) continue;
    pe.largest = seconds;
    pe.element = s.elements.index.empty() ? text("number ", i) : s.elements.index[i];
  }
  const double slowest = std::ranges::max_element(pes, {}, &PeLoad::busy)->busy;
  for (PeLoad& pe : pes) pe.seconds = slowest;
  return pes;
}

}  // namespace tess::balance
