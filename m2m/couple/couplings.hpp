// The couplings of a piece, as the piece keeps them.
#pragma once

#include "m2m/coupling_id.hpp"

#include <memory>

namespace tess::m2m {

struct CouplingSides;

/// The couplings of a piece. It migrates with the piece.
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

  std::unique_ptr<CouplingSides> sides_;
};

}  // namespace tess::m2m
