// What a piece knows of a coupling that gives it values. During a search: the candidates so far.
// After it: which source piece sends which rows, and the rows that have arrived.
#pragma once

#include "m2m/couple/messages.hpp"
#include "m2m/couple/rounds.hpp"
#include "m2m/mesh_view.hpp"
#include "m2m/rows/search/cover.hpp"
#include "m2m/rows/search/nearest_parts.hpp"

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace tess::m2m {

class TargetSide {
 public:
  CouplingSetup setup;

  /// Forgets the last search, and returns boxes around the points.
  [[nodiscard]] std::vector<Aabb> start_search(const MeshView& mesh);
  void add(const collide::Hits& hits);
  /// The queries to all source pieces that may hold points.
  [[nodiscard]] Addressed<DonorQuery> donor_queries(const MeshView& mesh);
  void add(const DonorAnswer& answer);
  void add(const NearestAnswer& answer);
  /// True if no answer is under way.
  [[nodiscard]] bool has_all_answers() const { return n_open_ == 0; }
  /// After the last answer: true if points need the nearest vertex, which takes name_sources().
  [[nodiscard]] bool needs_sources();
  /// True between the two.
  [[nodiscard]] bool waits() const { return !nearest_.empty() && sources_.empty(); }
  /// `sources`: all source pieces, sorted by owner.
  void name_sources(const MeshView& mesh, std::span<const SourcePiece> sources);
  /// The next queries for points that need a nearest vertex; none if all are answered.
  [[nodiscard]] Addressed<NearestQuery> nearest_queries(const MeshView& mesh);
  /// Ends the search: what each source piece that was asked shall send.
  [[nodiscard]] Addressed<Choice> choices(const MeshView& mesh);
  [[nodiscard]] const Tally& tally() const { return tally_; }
  [[nodiscard]] const WorstPlaces& worst() const { return worst_; }

  /// Per point owned.
  [[nodiscard]] std::span<const Status> status() const { return status_; }
  [[nodiscard]] std::span<const double> distance() const { return distance_; }
  [[nodiscard]] std::size_t n_sources() const { return rows_.size(); }

  /// The points that a source piece gives values to, in its order.
  [[nodiscard]] std::span<const std::int32_t> rows_from(collide::OwnerId source) const {
    return rows_.at(source);
  }

  void add(GivenValues rows);
  /// True if the next round of a channel has arrived as a whole.
  [[nodiscard]] bool has_next(std::uint64_t channel) const;
  /// Writes it to `values`: n_owned × n_components, row-major.
  void take_next(std::uint64_t channel, std::span<double> values);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(setup, cover_, asked_, best_, nearest_, to_ask_, nearest_parts_, sources_,
       source_has_points_, n_open_, tally_, worst_, status_, distance_, rows_, channels_);
  }

 private:
  /// The points that were sent to a source piece, and those of them that it holds.
  struct Asked {
    std::vector<std::uint32_t> boxes, source_boxes;  // of the two covers, from the hits
    std::vector<std::int32_t> rows;                  // per point sent
    std::vector<std::int32_t> held;                  // per answer: its row
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
    std::int32_t row = 0;
    double squared_distance = std::numeric_limits<double>::infinity();
    GlobalId id = std::numeric_limits<GlobalId>::max();
    VertexId vertex = -1;
    collide::OwnerId source{};
    NearestParts::RankedPart asked{};
  };
  Cover cover_;
  std::map<collide::OwnerId, Asked> asked_;
  std::vector<Best> best_;             // per point owned
  std::vector<NearestSoFar> nearest_;  // of the points that need a nearest vertex
  std::vector<std::uint32_t> to_ask_;  // those of them that may have a nearer one in another piece
  NearestParts nearest_parts_;
  std::vector<collide::OwnerId> sources_;  // of the parts in nearest_parts_
  bool source_has_points_ = false;         // any of these pieces has
  std::uint64_t n_open_ = 0;
  Tally tally_;
  WorstPlaces worst_;
  std::vector<Status> status_;
  std::vector<double> distance_;                                // per point owned
  std::map<collide::OwnerId, std::vector<std::int32_t>> rows_;  // per source piece, in its order
  std::map<std::uint64_t, Rounds<GivenValues>> channels_;
};

}  // namespace tess::m2m
