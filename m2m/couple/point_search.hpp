// The search of a target piece for the donors of its points: the candidates so far, and the
// vertices, or with kind projection the cells, that are nearest to points outside.
#pragma once

#include "m2m/couple/point_fits.hpp"
#include "m2m/couple/search_step.hpp"
#include "m2m/mesh_view.hpp"
#include "m2m/rows/search/cover.hpp"
#include "m2m/rows/search/nearest_parts.hpp"

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace tess::m2m {

class PointSearch {
 public:
  /// Starts, and returns boxes around the points.
  [[nodiscard]] std::vector<Aabb> start(const CouplingSetup& setup, const MeshView& mesh);
  void add(const collide::Hits& hits);
  /// When all answers to the last step are here. `found` is filled in at the end.
  [[nodiscard]] SearchStep next(const CouplingSetup& setup, const MeshView& mesh,
                                TargetFound& found);
  void add(const CouplingSetup& setup, collide::OwnerId from, const DonorAnswer& answer);
  void add(collide::OwnerId from, const NearestAnswer& answer);
  /// `sources`: all source pieces, sorted by owner, if the last step asks for them.
  void name_sources(const MeshView& mesh, std::span<const SourcePiece> sources);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(stage_, cover_, asked_, best_, nearest_, to_ask_, nearest_parts_, sources_,
       source_has_points_, fits_);
  }

 private:
  enum class Stage : std::uint8_t { ask, locate, name, ask_nearest };
  /// The points that were sent to a source piece, and those of them that it holds.
  struct Asked {
    std::vector<std::uint32_t> boxes{}, source_boxes{};  // of the two covers, from the hits
    std::vector<std::uint32_t> rows{};                   // per point sent
    std::vector<std::uint32_t> held{};                   // per answer: its row
    template <class Ar>
    void serialize(Ar& ar) {
      ar(boxes, source_boxes, rows, held);
    }
  };
  /// The best candidate of a point, and the source piece that has it.
  struct Best {
    Candidate candidate{};
    collide::OwnerId source{};
  };
  /// The nearest vertex found so far for a point, and the piece that was asked last.
  struct NearestSoFar {
    std::uint32_t row = 0;
    double squared_distance = std::numeric_limits<double>::infinity();
    GlobalId id = std::numeric_limits<GlobalId>::max();
    VertexId vertex = -1;
    collide::OwnerId source{};
    NearestParts::RankedPart asked{};
  };

  [[nodiscard]] Addressed<SearchQuery> point_queries(CouplingId id, const MeshView& mesh);
  void list_outside(TransferKind kind);
  [[nodiscard]] Addressed<Choice> fit_choices(CouplingId id, const MeshView& mesh,
                                              TargetFound& found) const;
  /// The next queries for points that need a nearest vertex, or cell; none if all are answered.
  [[nodiscard]] Addressed<SearchQuery> nearest_queries(const CouplingSetup& setup,
                                                       const MeshView& mesh);
  /// What each source piece that was asked shall send.
  [[nodiscard]] Addressed<Choice> choices(const CouplingSetup& setup, const MeshView& mesh,
                                          TargetFound& found);

  Stage stage_ = Stage::ask;
  Cover cover_;
  std::map<collide::OwnerId, Asked> asked_;
  std::vector<Best> best_;             // per point owned
  std::vector<NearestSoFar> nearest_;  // of the points that need a nearest vertex
  std::vector<std::uint32_t> to_ask_;  // those of them that may have a nearer one in another piece
  NearestParts nearest_parts_;
  std::vector<collide::OwnerId> sources_;  // of the parts in nearest_parts_
  bool source_has_points_ = false;         // any of these pieces has
  std::optional<PointFits> fits_;          // of moving least squares: by the keys of nearest_
};

}  // namespace tess::m2m
