// What a piece knows of its couplings: a side per coupling and role.
#pragma once

#include "m2m/couple/couplings.hpp"
#include "m2m/couple/overlap_source.hpp"
#include "m2m/couple/overlap_target.hpp"
#include "m2m/couple/source_side.hpp"
#include "m2m/couple/target_side.hpp"

#include <map>
#include <vector>

namespace tess::m2m {

/// True if no source piece gives a target piece values. That may be because it has no places for
/// them: it is told of rounds, too.
[[nodiscard]] bool is_alone(const auto& target_side) {
  return target_side.n_sources() == 0;
}

struct CouplingSides {
  std::map<CouplingId, SourceSide> sources{};
  std::map<CouplingId, TargetSide> targets{};
  std::map<CouplingId, OverlapSource> overlap_sources{};
  std::map<CouplingId, OverlapTarget> overlap_targets{};
  /// Target pieces without sources, which hear of each round from this source piece.
  std::map<CouplingId, std::vector<collide::OwnerId>> attached{};

  [[nodiscard]] bool is_conservative_source(CouplingId id) const {
    return overlap_sources.contains(id);
  }
  [[nodiscard]] bool is_conservative_target(CouplingId id) const {
    return overlap_targets.contains(id);
  }
  // They end the job if this piece has no such side.
  [[nodiscard]] SourceSide& source(CouplingId id);
  [[nodiscard]] TargetSide& target(CouplingId id);
  [[nodiscard]] OverlapSource& overlap_source(CouplingId id);
  [[nodiscard]] OverlapTarget& overlap_target(CouplingId id);
  /// Calls visit(side) with the target side, whichever kind it is of.
  template <class Visit>
  auto with_target(CouplingId id, const Visit& visit) {
    return is_conservative_target(id) ? visit(overlap_target(id)) : visit(target(id));
  }
  /// The target of a coupling that this piece is a source of.
  [[nodiscard]] const PieceArray& targets_of(CouplingId id) {
    return is_conservative_source(id) ? overlap_source(id).setup.target : source(id).setup.target;
  }
  void release(CouplingId id);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(sources, targets, overlap_sources, overlap_targets, attached);
  }
};

}  // namespace tess::m2m
