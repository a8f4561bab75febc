#include "runtime/balance/strategies/simple.hpp"

#include "runtime/balance/honour.hpp"
#include "runtime/core/hash.hpp"

namespace tess::balance {

Assignment none(const Snapshot& s) {
  return s.elements.pe;
}

Assignment rotate(const Snapshot& s) {
  Assignment wanted = s.elements.pe;
  for (PeId& pe : wanted) pe = pe_at((slot(pe) + 1) % s.pes.size());
  return honour(s, wanted);
}

Assignment random(const Snapshot& s, std::uint64_t seed) {
  Random next(seed);
  Assignment wanted = s.elements.pe;
  for (PeId& pe : wanted) pe = pe_at(next.below(s.pes.size()));
  return honour(s, wanted);
}

}  // namespace tess::balance
