// Strategies that ignore loads, for comparison and for testing applications.
#include "runtime/balance/honour.hpp"
#include "runtime/core/hash.hpp"

namespace tess::balance {

/// Every element stays.
Assignment none(const Snapshot& s) {
  return s.elements.pe;
}

/// Moves every element to the next PE, if it fits there.
Assignment rotate(const Snapshot& s) {
  Assignment wanted = s.elements.pe;
  for (PeId& pe : wanted) pe = pe_at((slot(pe) + 1) % s.pes.size());
  return honour(s, wanted);
}

/// Moves every element to a random PE, if it fits there.
Assignment random(const Snapshot& s, std::uint64_t seed) {
  Random next(seed);
  Assignment wanted = s.elements.pe;
  for (PeId& pe : wanted) pe = pe_at(next.below(s.pes.size()));
  return honour(s, wanted);
}

}  // namespace tess::balance
