#include "apps/leanmd/problem.hpp"

#include "apps/leanmd/forces.hpp"

#include <fmt/format.h>

namespace leanmd {

std::string describe(const Trouble& trouble, const Problem& problem) {
  const std::string where = fmt::format("step {}, atom {}: ", trouble.step, trouble.atom);
  switch (trouble.kind) {
    case Trouble::Kind::too_close:
      return where + fmt::format(
                         "another atom is at distance {:.4g}, closer than {}; lower --dt {} "
                         "or give atoms more room (--density)",
                         trouble.value, least_distance, problem.dt);
    case Trouble::Kind::too_fast:
      return where + fmt::format(
                         "its speed {:.4g} is too fast for --dt {}: it crosses a cell; lower "
                         "--dt, or give fewer --cells",
                         trouble.value, problem.dt);
    case Trouble::Kind::too_far:
      break;
  }
  return where + fmt::format(
                     "it may have moved by {:.4g} since the last exchange, more than half of "
                     "--skin {}; lower --exchange {} or --dt {}",
                     trouble.value, problem.skin, problem.exchange_every, problem.dt);
}

}  // namespace leanmd
