// What a piece knows of a coupling that gives it values. During a search: what it has asked and
// heard. After it: which source pieces give which places values, and the rounds under way. Values
// that are interpolated are written as they arrive. With conservative kinds loads arrive: means of
// cells follow from them at once, and values of points from a projection, in which the pieces of
// the target exchange the values of ghosts.
#pragma once

#include "m2m/couple/overlap_search.hpp"
#include "m2m/couple/point_search.hpp"
#include "m2m/couple/rounds.hpp"
#include "m2m/couple/transposed_search.hpp"
#include "m2m/rows/conservative/projection.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

namespace tess::m2m {

class TargetSide {
 public:
  CouplingSetup setup;

  /// Forgets the last search, and returns boxes around what gets values.
  [[nodiscard]] std::vector<Aabb> start_search(const MeshView& mesh);
  /// Starts that of a transposed coupling. `rows`: of the donors that the piece holds, per piece that
  /// they give values.
  void start_search(Addressed<Rows<double>> rows);
  /// What the piece reports of its points if there is a directory; `me`: the piece.
  [[nodiscard]] std::vector<PointReport> point_reports(const MeshView& mesh,
                                                       collide::OwnerId me) const;
  void add(const collide::Hits& hits);
  /// Returns true if the search goes on by next_step().
  [[nodiscard]] bool add(SearchAnswer answer);
  /// `sources`: all source pieces, sorted by owner; or the first one, if no piece asks for all.
  /// Returns the same.
  [[nodiscard]] bool name_sources(const MeshView& mesh, std::span<const SourcePiece> sources);
  /// What to send now. The first step follows the hits.
  [[nodiscard]] SearchStep next_step(const MeshView& mesh);
  /// What the search has found.
  [[nodiscard]] const TargetFound& found() const { return found_; }
  /// True if no source piece gives this one values, and it knows none that could report rounds. It
  /// may have no places for values: it takes rounds, too.
  [[nodiscard]] bool is_alone() const { return n_sources() == 0 && !least_source_; }
  [[nodiscard]] std::size_t n_sources() const { return found_.given.n_sources(); }

  void add(GivenValues given);
  /// Goes on with a channel as far as its messages allow. Sends values to holders of ghosts by
  /// send(piece, values). True if a round can be written.
  [[nodiscard]] bool advance(detail::Taker take,
                             const std::function<void(collide::OwnerId, GivenValues)>& send);
  /// Writes it to `values`: n_places × n_components, row-major.
  void write(std::uint64_t channel, std::span<double> values);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(setup, search_, n_open_, found_, least_source_, neighbours_, channels_);
  }

 private:
  /// A piece that shares points with this one. The points are sorted by id.
  struct Neighbour {
    bool takes_part = false;
    std::vector<std::pair<GlobalId, std::int32_t>> owned{};   // here; ghosts there
    std::vector<std::pair<GlobalId, std::int32_t>> ghosts{};  // here; owned there
    template <class Ar>
    void serialize(Ar& ar) {
      ar(takes_part, owned, ghosts);
    }
  };
  struct Channel {
    Rounds given{}, ghosts{};
    std::optional<Projection> projection{};  // of the present round
    std::uint32_t n_steps = 0;               // of all rounds
    bool waits = false;                      // for ghosts
    std::vector<double> result{};            // of loads
    template <class Ar>
    void serialize(Ar& ar) {
      ar(given, ghosts, projection, n_steps, waits, result);
    }
  };

  void forget();
  [[nodiscard]] std::size_t n_ghost_messages() const;
  void start_round(Channel& channel);
  void send_owned(Channel& channel, detail::Taker take,
                  const std::function<void(collide::OwnerId, GivenValues)>& send);
  void take_ghosts(Channel& channel);
  void write_given(const std::vector<GivenValues>& messages, std::span<double> to) const;
  void write_result(const std::vector<double>& result, std::span<double> to) const;

  // under way
  std::variant<std::monostate, PointSearch, OverlapSearch, TransposedSearch> search_;
  std::size_t n_open_ = 0;  // answers
  TargetFound found_;
  std::optional<collide::OwnerId> least_source_;  // of all, if the piece was told
  std::map<collide::OwnerId, Neighbour> neighbours_;
  std::map<std::uint64_t, Channel> channels_;
};

}  // namespace tess::m2m
