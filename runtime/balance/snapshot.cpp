#include "runtime/balance/snapshot.hpp"

#include "runtime/core/error.hpp"

#include <cmath>

namespace tess::balance {
namespace {

/// Sums below it fit into a signed word, as room on a PE is computed.
constexpr double most_memory_bytes = 0x1p60;

void validate_memory(const Snapshot& s) {
  const auto& e = s.elements;
  if ((!e.working_bytes.empty() && e.working_bytes.size() != e.size()) ||
      (!e.block.empty() && e.block.size() != e.size()) ||
      (!s.pes.working_bytes.empty() && s.pes.working_bytes.size() != s.pes.size()))
    fail(ErrorCode::bad_value, "snapshot: arrays of memory differ in length; give ", e.size(),
         " for elements, ", s.pes.size(), " for PEs");
  double all = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (e.block_of(i) != no_block && e.block_of(i) >= s.blocks.size())
      fail(ErrorCode::out_of_range, "snapshot: element ", i, " uses block ", e.block_of(i), " of ",
           s.blocks.size());
    all += static_cast<double>(e.memory_bytes[i]) + static_cast<double>(e.working_bytes_of(i));
  }
  for (const SharedBlock& block : s.blocks) {
    if (block.home.value < 0 || slot(block.home) >= s.pes.size())
      fail(ErrorCode::out_of_range, "snapshot: block ", block.id, " has its home on ", block.home,
           " of ", s.pes.size(), " PEs");
    all += static_cast<double>(block.bytes);
  }
  for (const std::uint64_t bytes : s.pes.working_bytes) all += static_cast<double>(bytes);
  if (!(all < most_memory_bytes))
    fail(ErrorCode::bad_value, "snapshot: its memory adds up to ", all,
         " bytes; give sizes whose sum is below 2^60");
}

}  // namespace

void validate(const Snapshot& s) {
  const auto& e = s.elements;
  const std::size_t n = e.size();
  const std::size_t n_pes = s.pes.size();
  if (e.pe.size() != n || e.load.size() != n || e.migratable.size() != n ||
      e.size_bytes.size() != n || e.memory_bytes.size() != n ||
      (!e.position.empty() && e.position.size() != n) || (!e.index.empty() && e.index.size() != n))
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
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (e.pe[i].value < 0 || slot(e.pe[i]) >= n_pes)
      fail(ErrorCode::out_of_range, "snapshot: element ", i, " on ", e.pe[i], " of ", n_pes,
           " PEs");
    const double load = e.load[i].seconds_or(0);
    sum += load;
    if (!std::isfinite(sum))
      fail(ErrorCode::bad_value, "snapshot: element ", i, " has load ", load,
           std::isfinite(load) ? ", and the sum of all is beyond all range" : "", "; give seconds");
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
  validate_memory(s);
}

}  // namespace tess::balance
