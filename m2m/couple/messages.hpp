// The messages between pieces of coupled meshes, in the order of the table in any_piece.hpp. A
// piece can be part of several couplings at once, so each message names its coupling. A piece is
// named by the owner id of its index.
//
// A place is what gets a value in the target: a point that a piece owns, or a cell. An unknown is
// what has a value in the source: a point, a tetrahedron or a corner of one.
#pragma once

#include "collide/collider.hpp"
#include "m2m/couple/ledger.hpp"
#include "m2m/couple/piece_array.hpp"
#include "m2m/couple/point_directory.hpp"
#include "m2m/policy.hpp"
#include "m2m/rows/conservative/overlap_rows.hpp"
#include "m2m/rows/interpolate/donor.hpp"
#include "m2m/transfer_kind.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

namespace tess::m2m {

/// The two sides of a collision, as models.
inline constexpr collide::ModelId source_model{1};
inline constexpr collide::ModelId target_model{2};

/// What all pieces know of a coupling.
struct CouplingSetup {
  CouplingId id{};
  collide::Collider collider;
  GroupProxy<Ledger> ledger;
  PieceArray source, target;
  OutsidePolicy policy{};
  TransferKind kind{};
  double tolerance = 0;
  Facing facing{};
  bool clamp = false;
  std::int32_t order = 1;
  Centring source_values{}, target_values{};
  GroupProxy<PointDirectory> directory;  ///< only where has_directory()
  CouplingId forth{};                    ///< the coupling whose rows are transposed, if any

  [[nodiscard]] bool is_conservative() const {
    return !is_transposed() && m2m::is_conservative(kind);
  }
  [[nodiscard]] bool is_transposed() const { return forth != CouplingId{}; }
  /// Pieces that are near are found by the collider.
  [[nodiscard]] bool collides() const { return !is_transposed() && !fits(); }
  /// Rows follow from the nearest vertices of each point.
  [[nodiscard]] bool fits() const { return kind == TransferKind::moving_least_squares; }
  /// Source pieces also send raw values, to which the target applies rows.
  [[nodiscard]] bool applies_at_target() const {
    return is_conservative() || is_transposed() || fits();
  }
  /// Points that no cell holds take the value at the nearest cell, however far it is.
  [[nodiscard]] bool seeks_nearest_cells() const {
    return kind == TransferKind::projection && tolerance == 0;
  }
  /// The values of points are the solution of a system of equations over all target pieces.
  [[nodiscard]] bool has_projection() const {
    return is_conservative() && target_values == Centring::nodes;
  }
  /// Target pieces learn which of their points others hold, too.
  [[nodiscard]] bool has_directory() const { return has_projection() || is_transposed(); }
};

/// Messages, each with the piece that it goes to.
template <class Message>
using Addressed = std::vector<std::pair<collide::OwnerId, Message>>;

/// Which of your cells hold these points?
struct DonorQuery {
  std::vector<std::uint32_t> boxes;  ///< of the source piece's cover, where there are points
  std::vector<Point> points;
  /// Which cells are nearest to them? Per point: farther ones are not of interest. Otherwise empty.
  std::vector<double> reaches{};
};
/// Which of your vertices are nearest to these points?
struct NearestQuery {
  std::uint32_t n_nearest = 1;
  std::vector<std::uint32_t> keys;  ///< per point, from the target piece: they come back
  std::vector<Point> points;
  std::vector<double> squared_reaches;  ///< per point: farther vertices are not of interest
};
/// From a target piece to a source piece. TargetTets: which of your tetrahedra overlap these?
struct SearchQuery {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::variant<DonorQuery, NearestQuery, TargetTets> what;
};

/// The best candidate of the source piece per point that it holds.
struct DonorAnswer {
  std::vector<std::uint32_t> points;  ///< indices into the points of the query
  std::vector<Candidate> candidates;
};
/// The nearest vertices within reach.
struct NearestAnswer {
  std::vector<std::uint32_t> keys;  ///< those of the query; one for each of its vertices
  std::vector<double> squared_distances;
  std::vector<GlobalId> ids;
  std::vector<VertexId> vertices;  ///< in the source piece
  std::vector<Point> points;       ///< if more than one is asked for
};
/// Says which tetrahedra overlap, how much of them, and which unknowns of the query have a row.
struct OverlapAnswer {
  std::vector<std::uint32_t> tets;  ///< positions in the query
  std::vector<std::array<double, 4>> covered;
  std::vector<std::uint32_t> rows;  ///< positions among the query's unknowns
};
/// The reply to the Choice of a conservative search: the source piece's part of the rows that it
/// does not keep. The target adds the parts of several source pieces and applies these rows itself.
struct PartialRows {
  std::vector<GlobalId> ids;            ///< of all unknowns in them, ascending
  std::vector<std::uint32_t> first{0};  ///< per row, and the end: its first column
  std::vector<std::uint32_t> columns;   ///< positions in ids, ascending in a row
  std::vector<double> weights;
};
/// From a target piece to those beside it: it takes part in projections.
struct Greeting {};
/// In the search of a transposed coupling, from a piece that gives forces: its points whose donors
/// the receiver holds, in the order of these.
struct DonatedPoints {
  std::vector<GlobalId> ids;
  std::vector<VertexId> points;  ///< in the sender
};
/// A weight of a transposed row.
struct TransposedWeight {
  VertexId vertex = 0;  ///< gets the force: in the piece that owns it
  VertexId point = 0;   ///< gives it: in `piece`
  GlobalId point_id = 0;
  collide::OwnerId piece{};
  double weight = 0;
};
/// Weights of the receiver's vertices, from a piece that holds ghosts of them, or from one whose
/// points have rows without donors.
struct TransposedWeights {
  std::vector<TransposedWeight> weights;
};
/// To a target piece, in a search. SharedPoints are the directory's reply to its reports.
struct SearchAnswer {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::variant<DonorAnswer, NearestAnswer, OverlapAnswer, PartialRows, SharedPoints, Greeting,
               DonatedPoints, TransposedWeights>
      what;
};

/// The end of a search, from a target piece to a source piece: what to send from now on, in this
/// order.
struct Choice {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<std::uint32_t> kept;  ///< positions among the points or rows of the answer, ascending
  std::vector<VertexId> vertices;   ///< for points outside
  bool is_alone = false;  ///< no values, but word of each round: no source piece gives it values
};

/// Values for a target piece: per donor in the order of its Choice. With conservative kinds the
/// loads of the rows that were kept; if the kind is bounded, as many pairs (low, high); then the
/// values of PartialRows::ids. With rows of the target those of Choice::vertices. All have
/// n_components columns.
struct GivenValues {
  CouplingId coupling{};
  collide::OwnerId from{};
  detail::Taker take;          ///< a member of the target's class; each is a channel
  std::uint32_t number = 0;    ///< counts the applications of the channel
  std::vector<double> values;  ///< n_rows × n_components, row-major
  /// From a piece of the target, within a projection: values of points that the receiver holds as
  /// ghosts, by ascending id. `number` counts the steps of the channel.
  bool are_ghosts = false;
};

}  // namespace tess::m2m
