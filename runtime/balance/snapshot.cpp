#include "runtime/balance/snapshot.hpp"

#include "runtime/core/error.hpp"

#include <cmath>

namespace tess::balance {

void validate(const Snapshot& s) {
  const auto& e = s.elements;
  const std::size_t n = e.size();
  const std::size_t n_pes = s.pes.size();
  if (e.pe.size() != n || e.load.size() != n || e.migratable.size() != n ||
      e.size_bytes.size() != n || e.memory_bytes.size() != n ||
      (!e.measured.empty() && e.measured.size() != n) ||
      (!e.position.empty() && e.position.size() != n))
    fail(ErrorCode::bad_value, "snapshot: arrays of elements differ in length; give each ", n);
  if (n_pes == 0 || s.pes.background.size() != n_pes || s.pes.memory_limit_bytes.size() != n_pes)
    fail(ErrorCode::bad_value,
         "snapshot: arrays of PEs differ in length or are empty; speeds: ", n_pes);
  for (std::size_t p = 0; p < n_pes; ++p)
    if (!(s.pes.speed[p] > 0) || !std::isfinite(s.pes.speed[p]) || !(s.pes.background[p] >= 0) ||
        !std::isfinite(s.pes.background[p]))
      fail(ErrorCode::bad_value, "snapshot: PE ", p, " has speed ", s.pes.speed[p],
           " and background ", s.pes.background[p],
           "; speed must be above 0, background not below");
  for (std::size_t i = 0; i < n; ++i) {
    if (e.pe[i].value < 0 || slot(e.pe[i]) >= n_pes)
      fail(ErrorCode::out_of_range, "snapshot: element ", i, " on ", e.pe[i], " of ", n_pes,
           " PEs");
    if (!(e.load[i] >= 0) || !std::isfinite(e.load[i]))
      fail(ErrorCode::bad_value, "snapshot: element ", i, " has load ", e.load[i],
           "; give seconds");
    if (e.position.empty()) continue;
    for (const double x : e.position[i])
      if (!std::isfinite(x))
        fail(ErrorCode::bad_value, "snapshot: element ", i, " has coordinate ", x,
             "; give numbers");
  }
  for (const Edge& edge : s.edges)
    if (edge.from >= n || edge.to >= n)
      fail(ErrorCode::out_of_range, "snapshot: edge ", edge.from, " to ", edge.to, " of ", n,
           " elements");
}

}  // namespace tess::balance
