// Sums of a coupling over its pieces, kept per PE. Pieces do not contribute to a reduction of their
// own array: it would mix with the application's reductions.
#pragma once

#include "collide/collider.hpp"
#include "m2m/couple/turns.hpp"
#include "m2m/coupling_id.hpp"
#include "m2m/mesh.hpp"
#include "m2m/tally.hpp"
#include "m2m/worst_places.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tess::m2m {

/// A source piece, whether it has points and tetrahedra, and the box around the points that it
/// owns: with tetrahedra those that they use, since no other point is the nearest.
struct SourcePiece {
  collide::OwnerId owner{};
  Aabb box{};
  std::uint8_t has_points = 0, has_tets = 0;
};

struct LedgerPage {
  Tally tally;
  WorstPlaces worst;
  std::uint64_t n_waiting = 0;  ///< target pieces with points that need the nearest vertex
  std::vector<SourcePiece> sources;
  std::uint64_t n_alone = 0;  ///< target pieces that no source piece gives values

  LedgerPage& operator+=(const LedgerPage& other) {
    tally += other.tally;
    worst += other.worst;
    n_waiting += other.n_waiting;
    sources.insert(sources.end(), other.sources.begin(), other.sources.end());
    n_alone += other.n_alone;
    return *this;
  }
};
/// Joins the pages of all PEs.
struct JoinPages {
  LedgerPage operator()(LedgerPage a, const LedgerPage& b) const {
    a += b;
    return a;
  }
};

class Ledger : public Group<Ledger> {
 public:
  /// Called by pieces on this PE.
  void add(const Tally& tally) { page_.tally += tally; }
  void add(const WorstPlaces& worst) { page_.worst += worst; }
  void add(const SourcePiece& source) { page_.sources.push_back(source); }
  void add_waiting() { ++page_.n_waiting; }
  void add_alone() { ++page_.n_alone; }

  /// Entry method: a search uses the source pieces that are there now.
  void keep_pieces(CollectionId source) {
    source_ = source;
    n_destroyed_ = destroyed_here(source).first;
    lost_.clear();
  }
  /// Ends the job if one of them was destroyed on this PE: a target piece would lack its values.
  void require_pieces(CouplingId coupling, CollectionId source) {
    const std::string lost = lost_of(source);
    TESS_CHECK(lost.empty(), lost, ", a source piece of coupling ",
               static_cast<std::uint64_t>(coupling),
               ", was destroyed after the last search: search again before values are given");
  }

  /// The turns of the applications that start on this PE, by any copy of the handle.
  [[nodiscard]] std::shared_ptr<Turns> turns() const { return turns_; }

  /// For checkpoints, between searches. A new run counts destroyed pieces from 0 on.
  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (!Ar::is_reading) lost_ = lost_of(source_);
    ar(source_, lost_);
  }
  void absorb(Ledger&& other) {
    if (lost_.empty()) lost_ = std::move(other.lost_);
  }

  /// Entry method: gives the sums since the last call.
  void close_page(Callback<LedgerPage> target) {
    contribute(JoinPages{}, std::exchange(page_, {}), std::move(target));
  }

 private:
  /// Asks about an array of any class.
  static std::pair<std::uint64_t, std::string> destroyed_here(CollectionId array) {
    return ArrayProxy<Ledger>(array).destroyed_here();
  }

  /// A source piece that was destroyed after the last search, on this PE or before a restart.
  [[nodiscard]] std::string lost_of(CollectionId source) const {
    const auto [n, last] = destroyed_here(source);
    return n == n_destroyed_ ? lost_ : last;
  }

  LedgerPage page_;
  CollectionId source_{};  // of the last search
  std::uint64_t n_destroyed_ = 0;
  std::string lost_;  // what lost_of() found when the run was saved; empty: nothing
  std::shared_ptr<Turns> turns_ = std::make_shared<Turns>();
};

}  // namespace tess::m2m
