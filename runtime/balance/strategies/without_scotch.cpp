// In place of graph.cpp where Scotch is missing.
#include "runtime/balance/strategies/graph.hpp"
#include "runtime/core/error.hpp"

namespace tess::balance {

bool graph_is_built() {
  return false;
}

Assignment graph(const Snapshot& /*snapshot*/, std::uint64_t /*seed*/, double /*tolerance*/) {
  fail(ErrorCode::environment,
       "balance strategy 'graph': Tessera is built without Scotch: install it (libscotch-dev) and "
       "build again, or choose another strategy");
}

}  // namespace tess::balance
