#include "m2m/couple/couplings.hpp"

#include "m2m/couple/source_side.hpp"
#include "m2m/couple/target_side.hpp"
#include "runtime/core/check.hpp"

#include <map>

namespace tess::m2m {

struct Couplings::Sides {
  std::map<CouplingId, SourceSide> sources{};
  std::map<CouplingId, TargetSide> targets{};
};

Couplings::Couplings() : sides_(std::make_unique<Sides>()) {}
Couplings::Couplings(Couplings&&) noexcept = default;
Couplings& Couplings::operator=(Couplings&&) noexcept = default;
Couplings::~Couplings() = default;

template <class Ar>
void Couplings::serialize(Ar& ar) {
  ar(sides_->sources, sides_->targets);
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

SourceSide& Couplings::source(CouplingId id) const {
  return side_of(sides_->sources, id, "source");
}
TargetSide& Couplings::target(CouplingId id) const {
  return side_of(sides_->targets, id, "target");
}
SourceSide& Couplings::add_source(CouplingId id) {
  return sides_->sources[id];
}
TargetSide& Couplings::add_target(CouplingId id) {
  return sides_->targets[id];
}

void Couplings::release(CouplingId id) {
  sides_->sources.erase(id);
  sides_->targets.erase(id);
}

}  // namespace tess::m2m
