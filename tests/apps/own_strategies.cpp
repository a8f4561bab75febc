// A library for --strategy-library. The environment says what is wrong with it.
#include "runtime/more/balance_offline.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace {

using tess::balance::Assignment;
using tess::balance::Snapshot;

/// All elements go to the last PE.
Assignment last(const Snapshot& snapshot) {
  return Assignment(snapshot.elements.size(), tess::balance::pe_at(snapshot.pes.size() - 1));
}
Assignment throws(const Snapshot& /*snapshot*/) {
  throw std::runtime_error("boom");
}
Assignment too_short(const Snapshot& snapshot) {
  return Assignment(snapshot.elements.size() - 1);
}

}  // namespace

extern "C" void tess_register_strategies() {
  const char* const given = std::getenv("TESS_TEST_STRATEGIES");
  const std::string fault = given != nullptr ? given : "";
  if (fault == "none") return;
  if (fault == "fails") throw std::runtime_error("no memory of it");
  if (fault == "version")
    tess::balance::register_strategy("last", last, tess::balance::snapshot_version + 1);
  tess::balance::register_strategy(fault == "taken" ? "greedy" : "last", fault == "short"
                                                                             ? too_short
                                                                         : fault == "boom" ? throws
                                                                                           : last);
}
