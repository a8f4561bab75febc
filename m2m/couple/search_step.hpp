// What the searches of a target piece (PointSearch, OverlapSearch, TransposedSearch) send, and what
// they find. A search is a chain of steps: each one follows when all answers to the one before are
// here.
#pragma once

#include "m2m/couple/given_places.hpp"
#include "m2m/couple/messages.hpp"
#include "m2m/rows/conservative/mass_matrix.hpp"

#include <cstdint>
#include <vector>

namespace tess::m2m {

struct SearchStep {
  enum class Then : std::uint8_t {
    answers,  ///< answers come, and then the next step
    sources,  ///< the piece must know all source pieces
    nothing,  ///< the search of this piece has ended
  };
  Then then = Then::answers;
  Addressed<SearchQuery> queries{};
  Addressed<Choice> choices{};
  Addressed<SearchAnswer> beside{};  ///< to other pieces of the target
};

/// What a search finds for a target piece; it is kept for applications.
struct TargetFound {
  std::vector<Status> status{};  ///< per place; `snapped` stands for covered in part, too
  /// Per point that the piece owns; empty: conservative kinds, transposed couplings.
  std::vector<double> distance{};
  std::vector<std::int8_t> side{};  ///< likewise, of a wall; empty: all are 0
  Tally tally{};
  WorstPlaces worst{};
  GivenPlaces given{};
  MassMatrix mass{};                      ///< of points, if there is a projection
  std::vector<double> covered_volumes{};  ///< per cell, if cells get values

  template <class Ar>
  void serialize(Ar& ar) {
    ar(status, distance, side, tally, worst, given, mass, covered_volumes);
  }
};

}  // namespace tess::m2m
