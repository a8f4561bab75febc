// The messages between pieces of coupled meshes. A piece can be part of several couplings at once,
// so each message names its coupling. A piece is named by the owner id of its index.
#pragma once

#include "collide/collider.hpp"
#include "m2m/couple/ledger.hpp"
#include "m2m/couple/piece_array.hpp"
#include "m2m/couple/point_directory.hpp"
#include "m2m/policy.hpp"
#include "m2m/rows/interpolate/donor.hpp"
#include "m2m/transfer_kind.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <utility>
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
  bool clamp = false;
  Centring source_values{}, target_values{};
  GroupProxy<PointDirectory> directory;  ///< only where target pieces exchange values of ghosts
};

/// Messages, each with the piece that it goes to.
template <class Message>
using Addressed = std::vector<std::pair<collide::OwnerId, Message>>;

/// From a target piece to a source piece: which of your tetrahedra hold these points?
struct DonorQuery {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<std::uint32_t> boxes;  ///< of the source piece's cover, where there are points
  std::vector<Point> points;
};
/// The reply: the best candidate of the source piece per point that it holds.
struct DonorAnswer {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<std::uint32_t> points;  ///< indices into the points of the query
  std::vector<Candidate> candidates;
};

/// From a target piece to a source piece: which of your vertices are nearest to these points?
struct NearestQuery {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<std::uint32_t> keys;  ///< per point, from the target piece: they come back
  std::vector<Point> points;
  std::vector<double> squared_reaches;  ///< per point: farther vertices are not of interest
};
/// The reply: the nearest vertex per point; -1 if none is within reach.
struct NearestAnswer {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<std::uint32_t> keys;  ///< those of the query
  std::vector<double> squared_distances;
  std::vector<GlobalId> ids;
  std::vector<VertexId> vertices;  ///< in the source piece
};

/// The end of a search, from a target piece to a source piece that it asked: what to send from now
/// on, in this order.
struct Choice {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<std::uint32_t> answers;  ///< positions in the source piece's DonorAnswer
  std::vector<VertexId> vertices;      ///< for points outside
};

/// Values for a target piece, in the order of its Choice.
struct GivenValues {
  CouplingId coupling{};
  collide::OwnerId from{};
  detail::Taker take;          ///< a member of the target's class; each is a channel
  std::uint32_t round = 0;     ///< counts the applications of the channel
  std::vector<double> values;  ///< n_rows × n_components, row-major
};

}  // namespace tess::m2m
