// The couplings of a piece, as the piece keeps them.
#pragma once

#include "m2m/coupling_id.hpp"

#include <memory>

namespace tess::m2m {

class SourceSide;
class TargetSide;

/// What a piece knows of its couplings: a side per coupling and role. It migrates with the piece.
class Couplings {
 public:
  Couplings();
  Couplings(Couplings&&) noexcept;
  Couplings& operator=(Couplings&&) noexcept;
  ~Couplings();

  template <class Ar>
  void serialize(Ar& ar);

 private:
  friend class AnyPiece;
  struct Sides;

  // They end the job if this piece has no such side.
  [[nodiscard]] SourceSide& source(CouplingId id) const;
  [[nodiscard]] TargetSide& target(CouplingId id) const;
  // They make it if there is none.
  [[nodiscard]] SourceSide& add_source(CouplingId id);
  [[nodiscard]] TargetSide& add_target(CouplingId id);
  void release(CouplingId id);

  std::unique_ptr<Sides> sides_;
};

}  // namespace tess::m2m
