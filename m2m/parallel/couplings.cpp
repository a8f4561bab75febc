#include "m2m/parallel/couplings.hpp"

#include "runtime/core/check.hpp"

namespace tess::m2m {

SourceSide& Couplings::source(CouplingId id) {
  const auto at = sources.find(id);
  TESS_CHECK(at != sources.end(),
             "this piece is no source of the coupling: await search() first, and serialise "
             "`couplings` if pieces migrate");
  return at->second;
}
TargetSide& Couplings::target(CouplingId id) {
  return const_cast<TargetSide&>(static_cast<const Couplings&>(*this).target(id));
}
const TargetSide& Couplings::target(CouplingId id) const {
  const auto at = targets.find(id);
  TESS_CHECK(at != targets.end(),
             "this piece is no target of the coupling: await search() first, and serialise "
             "`couplings` if pieces migrate");
  return at->second;
}

void Couplings::release(CouplingId id) {
  sources.erase(id);
  targets.erase(id);
  overlap_sources.erase(id);
  overlap_targets.erase(id);
}

}  // namespace tess::m2m
