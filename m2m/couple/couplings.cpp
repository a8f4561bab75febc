#include "m2m/couple/couplings.hpp"

#include "m2m/couple/coupling_sides.hpp"
#include "runtime/core/check.hpp"

namespace tess::m2m {

Couplings::Couplings() : sides_(std::make_unique<CouplingSides>()) {}
Couplings::Couplings(Couplings&&) noexcept = default;
Couplings& Couplings::operator=(Couplings&&) noexcept = default;
Couplings::~Couplings() = default;

template <class Ar>
void Couplings::serialize(Ar& ar) {
  ar(*sides_);
}
template void Couplings::serialize(Reader&);
template void Couplings::serialize(Writer&);

namespace {

template <class Sides>
auto& side_of(Sides& sides, CouplingId id, const char* side) {
  const auto at = sides.find(id);
  TESS_CHECK(at != sides.end(), "this piece is no ", side,
             " of the coupling: await search() first, use it before its destroy(), and serialise "
             "`couplings` if pieces migrate");
  return at->second;
}

}  // namespace

SourceSide& CouplingSides::source(CouplingId id) {
  return side_of(sources, id, "source");
}
TargetSide& CouplingSides::target(CouplingId id) {
  return side_of(targets, id, "target");
}
OverlapSource& CouplingSides::overlap_source(CouplingId id) {
  return side_of(overlap_sources, id, "source");
}
OverlapTarget& CouplingSides::overlap_target(CouplingId id) {
  return side_of(overlap_targets, id, "target");
}

void CouplingSides::release(CouplingId id) {
  sources.erase(id);
  targets.erase(id);
  overlap_sources.erase(id);
  overlap_targets.erase(id);
  attached.erase(id);
}

}  // namespace tess::m2m
