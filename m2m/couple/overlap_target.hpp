// What a piece knows of a conservative coupling that gives it values: the search for overlaps, and
// the projections under way. A place is what gets a value: a point that the piece owns, or a cell.
#pragma once

#include "m2m/couple/overlap_loads.hpp"
#include "m2m/couple/overlap_messages.hpp"
#include "m2m/couple/point_directory.hpp"
#include "m2m/couple/rounds.hpp"
#include "m2m/rows/conservative/projection.hpp"

#include <map>
#include <optional>
#include <utility>

namespace tess::m2m {

class OverlapTarget {
 public:
  CouplingSetup setup;

  /// Forgets the last search, and returns boxes around the tetrahedra that get loads.
  [[nodiscard]] std::vector<Aabb> start_search(const MeshView& mesh);
  /// What the piece reports of its points; `me`: the piece.
  [[nodiscard]] std::vector<PointReport> point_reports(const MeshView& mesh,
                                                       collide::OwnerId me) const;
  void add(const collide::Hits& hits);
  [[nodiscard]] Addressed<OverlapQuery> queries(const MeshView& mesh);
  void add(const OverlapAnswer& answer);
  /// Before queries().
  void add(const SharedPoints& shared);
  /// After all answers.
  [[nodiscard]] Addressed<SharedRows> shared_rows();
  void add(PartialRows partial) { loads_.add(std::move(partial)); }
  /// After all of these: masses and statuses. Returns the pieces that must know that this one takes
  /// part in projections.
  [[nodiscard]] std::vector<collide::OwnerId> finish_search(const MeshView& mesh);
  void add_neighbour(collide::OwnerId piece) { neighbours_.at(piece).takes_part = true; }
  [[nodiscard]] const Tally& tally() const { return tally_; }

  /// Per point or cell that gets a value. `snapped` stands for covered in part.
  [[nodiscard]] std::span<const Status> status() const { return status_; }
  [[nodiscard]] std::size_t n_sources() const { return loads_.n_sources(); }

  void add(GivenValues loads);
  void add(GhostValues ghosts);
  /// Goes on with a channel as far as its messages allow. Sends values to holders of ghosts by
  /// send(piece, GhostValues). True if a round has ended: then values() are its result.
  template <class Send>
  [[nodiscard]] bool advance(detail::Taker take, const Send& send);
  /// Writes the result of a round: a row per status, where there is a value.
  void write(std::uint64_t channel, std::span<double> to) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(setup, numbers_, volumes_, cover_, asked_, covered_, loads_, mass_, neighbours_, tally_,
       status_, channels_);
  }

 private:
  /// The tetrahedra and places that were sent to a source piece.
  struct Asked {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> boxes{};  // (mine, theirs), from the hits
    std::vector<std::uint32_t> tets{};                             // as positions in numbers_
    std::vector<std::uint32_t> places{};                           // that may get a row
    template <class Ar>
    void serialize(Ar& ar) {
      ar(boxes, tets, places);
    }
  };
  /// A piece that shares points with this one.
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
    Rounds<GivenValues> loads{};
    Rounds<GhostValues> ghosts{};
    std::optional<Projection> projection{};  // of the present round
    std::uint32_t n_steps = 0;               // of all rounds
    bool waits = false;                      // for ghosts
    std::vector<double> result{};
    template <class Ar>
    void serialize(Ar& ar) {
      ar(loads, ghosts, projection, n_steps, waits, result);
    }
  };

  [[nodiscard]] bool to_cells() const { return setup.target_values == Centring::cells; }
  [[nodiscard]] std::array<std::uint32_t, 4> places_of(const MeshView& mesh,
                                                       std::uint32_t tet) const;
  [[nodiscard]] std::vector<double> covered_fractions(const MeshView& mesh);
  void start_round(Channel& channel);
  void take_ghosts(Channel& channel);
  [[nodiscard]] std::size_t n_ghost_messages() const;

  std::vector<std::int32_t> numbers_;  // of the tetrahedra that give a place loads, by id
  std::vector<double> volumes_;        // around each point, ghosts included; or of each cell
  Cover cover_;
  std::map<collide::OwnerId, Asked> asked_;
  std::vector<std::array<double, 4>> covered_;  // per number: loads of the constant 1
  OverlapLoads loads_;
  MassMatrix mass_;  // of points
  std::map<collide::OwnerId, Neighbour> neighbours_;
  Tally tally_;
  std::vector<Status> status_;
  std::map<std::uint64_t, Channel> channels_;
};

template <class Send>
bool OverlapTarget::advance(detail::Taker take, const Send& send) {
  Channel& channel = channels_[take->channel];
  for (;;) {
    if (channel.waits) {
      if (!channel.ghosts.has_next(n_ghost_messages())) return false;
      take_ghosts(channel);
    } else if (!channel.projection) {
      if (!channel.loads.has_next(n_sources())) return false;
      start_round(channel);
      if (to_cells()) return true;
    }
    if (!channel.projection->step(mass_)) {
      channel.result.assign(channel.projection->values().begin(),
                            channel.projection->values().end());
      channel.projection.reset();
      return true;
    }
    const std::size_t n = channel.projection->n_columns();
    const std::span<const double> shared = channel.projection->shared();
    for (const auto& [piece, neighbour] : neighbours_) {
      if (!neighbour.takes_part || neighbour.owned.empty()) continue;
      GhostValues message{setup.id, {}, take, channel.n_steps, {}};
      for (const auto& [id, point] : neighbour.owned) {
        const auto row = shared.subspan(static_cast<std::size_t>(point) * n, n);
        message.values.insert(message.values.end(), row.begin(), row.end());
      }
      send(piece, std::move(message));
    }
    ++channel.n_steps;
    channel.waits = n_ghost_messages() > 0;
  }
}

}  // namespace tess::m2m
