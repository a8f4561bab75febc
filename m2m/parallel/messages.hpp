// The messages of a transfer between Workers. A Worker can take part in several transfers at once,
// so each message names its transfer.
#pragma once

#include "collide/collider.hpp"
#include "m2m/interpolate/candidate.hpp"
#include "m2m/interpolate/locate.hpp"
#include "m2m/partition/split.hpp"
#include "m2m/policy.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tess::m2m {

class Worker;

/// A transfer; unique within the run.
enum class TransferId : std::uint64_t {};

/// The two sides of a collision, as models.
inline constexpr collide::ModelId source_model{1};
inline constexpr collide::ModelId target_model{2};

/// Starts a transfer at all Workers of both meshes.
struct TransferSetup {
  TransferId id{};
  collide::Collider collider;
  ArrayProxy<Worker> source;
  ArrayProxy<Worker> target;
};

/// The part of a mesh that a Worker holds, with its values.
struct PartLoad {
  MeshPart part;
  std::uint64_t n_components = 0;
  std::vector<double> values;  ///< part.points.size() × n_components, row-major
};

/// From a target Worker to a source Worker: which of these points lie in which tetrahedra?
struct Query {
  TransferId transfer{};
  Index1 from;                     ///< the target Worker
  std::vector<std::int32_t> rows;  ///< per point: its row in the target Worker
  std::vector<Point> points;
  std::vector<PointPair> pairs;  ///< (tetrahedron of the source Worker, index into points)
};

/// The reply: the best candidate of the source Worker per point that it holds.
struct Answer {
  TransferId transfer{};
  std::vector<std::int32_t> rows;
  std::vector<Candidate> candidates;  ///< per row
  std::vector<double> values;         ///< rows.size() × n_components, row-major
};

/// From a target Worker to a source Worker: which of your vertices are nearest to these points?
struct NearestQuery {
  TransferId transfer{};
  Index1 from;
  std::vector<std::int32_t> rows;
  std::vector<Point> points;
  std::vector<double> squared_reaches;  ///< per point: farther vertices are not of interest
};
/// The reply: the nearest vertex per point; -1 if none is within reach.
struct NearestAnswer {
  TransferId transfer{};
  std::vector<std::int32_t> rows;  ///< those of the query
  std::vector<double> squared_distances;
  std::vector<GlobalId> vertices;
  std::vector<double> values;  ///< rows.size() × n_components, row-major
};

/// Gives vertices outside the source their values.
struct OutsideRequest {
  TransferId transfer{};
  OutsidePolicy policy;
  std::vector<Aabb> source_boxes;  ///< of the parts of the source, if the policy is Nearest
};

/// New values for the ghosts that a Worker holds.
struct GhostRows {
  TransferId transfer{};
  std::vector<std::int32_t> rows;  ///< of the receiver
  std::vector<double> values;      ///< rows.size() × n_components, row-major
};

/// The number of target vertices per Status, and the number of candidate pairs tested.
struct Tally {
  std::array<std::uint64_t, 4> counts{};
  std::uint64_t n_candidates = 0;
};
/// Adds tallies in a reduction.
struct AddTallies {
  Tally operator()(Tally a, const Tally& b) const {
    for (std::size_t s = 0; s < a.counts.size(); ++s) a.counts[s] += b.counts[s];
    a.n_candidates += b.n_candidates;
    return a;
  }
};

/// The vertices that a Worker owns, with status and values, as gathered from a mesh. Before the
/// first transfer into the mesh every status is `outside`.
struct Outcome {
  std::vector<GlobalId> points;
  std::vector<Status> status;  ///< per vertex, from the transfer into the mesh that ended last
  std::vector<double> values;  ///< points.size() × n_components, row-major
};
/// Joins outcomes in a reduction.
struct JoinOutcomes {
  Outcome operator()(Outcome a, const Outcome& b) const;
};

}  // namespace tess::m2m
