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

/// Of an array or group of any class.
bool has_ended(CollectionId id) {
  return ArrayProxy<Ledger>(id).ended();
}

}  // namespace

void detail::require_usable(const CouplingSetup& setup, CollectionId source, CollectionId target,
                            const char* use) {
  TESS_CHECK(source != CollectionId{} && target != CollectionId{}, "a coupling without arrays is ",
             use, ": give its constructor the arrays that create() returned");
  TESS_CHECK(
      !has_ended(source) && !has_ended(target), "a coupling is ", use,
      " after an array of its pieces was destroyed: make a new Coupling of arrays that exist");
  TESS_CHECK(
      setup.id == CouplingId{} || !has_ended(setup.ledger.id()), "a coupling is ", use,
      " that another copy of the handle has destroyed: use the copy that called destroy(), or "
      "make a new Coupling");
}

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
