#include "m2m/parallel/couplings.hpp"

#include "runtime/core/check.hpp"

namespace tess::m2m {

namespace {

template <class Sides>
auto& side_of(Sides& sides, CouplingId id, const char* side) {
  const auto at = sides.find(id);
  TESS_CHECK(at != sides.end(), "this piece is no ", side,
             " of the coupling: await search() first, and serialise `couplings` if pieces migrate");
  return at->second;
}

}  // namespace

SourceSide& Couplings::source(CouplingId id) {
  return side_of(sources, id, "source");
}
TargetSide& Couplings::target(CouplingId id) {
  return side_of(targets, id, "target");
}
const TargetSide& Couplings::target(CouplingId id) const {
  return side_of(targets, id, "target");
}
OverlapSource& Couplings::overlap_source(CouplingId id) {
  return side_of(overlap_sources, id, "source");
}
OverlapTarget& Couplings::overlap_target(CouplingId id) {
  return side_of(overlap_targets, id, "target");
}
const OverlapTarget& Couplings::overlap_target(CouplingId id) const {
  return side_of(overlap_targets, id, "target");
}

void Couplings::release(CouplingId id) {
  sources.erase(id);
  targets.erase(id);
  overlap_sources.erase(id);
  overlap_targets.erase(id);
}

}  // namespace tess::m2m
