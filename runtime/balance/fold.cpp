#include "runtime/balance/fold.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::balance {

Fold parse_fold(std::string_view name) {
  if (name == "block") return Fold::block;
  if (name == "modulo") return Fold::modulo;
  fail(ErrorCode::bad_argument, "no fold '", name, "'; choose one of block, modulo");
}

Snapshot fold(Snapshot snapshot, std::size_t n_pes, Fold how) {
  TESS_CHECK(n_pes > 0, "a snapshot cannot be folded onto 0 PEs");
  const std::size_t n_before = snapshot.pes.size();
  if (n_pes == n_before) return snapshot;
  const auto folded = [&](PeId pe) {
    return pe_at(how == Fold::block ? slot(pe) * n_pes / n_before : slot(pe) % n_pes);
  };
  for (PeId& pe : snapshot.elements.pe) pe = folded(pe);
  for (SharedBlock& block : snapshot.blocks) block.home = folded(block.home);
  if (auto& working = snapshot.pes.working_bytes; !working.empty())
    working.assign(n_pes, std::ranges::max(working));
  snapshot.pes.background.assign(n_pes, 0);
  snapshot.pes.speed.assign(n_pes, 1);
  snapshot.pes.memory_limit_bytes.assign(n_pes, 0);
  return snapshot;
}

}  // namespace tess::balance
