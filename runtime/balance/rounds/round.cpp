#include "runtime/balance/rounds/round.hpp"

#include <fmt/core.h>

namespace tess::balance {

std::string describe(const Round& round, const Round* last) {
  std::string line = fmt::format(
      "balance round {} {}: {} of {} elements moved, {} bytes, max/average {:.3f} -> {:.3f} "
      "predicted, {:.3f} ms (strategy {:.3f} ms)",
      round.number, round.strategy, round.n_moved, round.n_elements, round.moved_bytes,
      round.before, round.predicted, 1e3 * round.round_seconds, 1e3 * round.strategy_seconds);
  if (round.n_unknown > 0)
    line += fmt::format("; {} loads are not known yet", round.n_unknown);
  else if (round.skipped)
    line += "; nothing to gain";
  if (round.rolled_back) line += "; the round before is undone";
  if (last != nullptr && last->measured > 0)
    line += fmt::format("; round {} measured {:.3f}, gain {:.1f} %", last->number, last->measured,
                        100 * last->gain);
  return line;
}

}  // namespace tess::balance
