// The messages of a transfer between Workers. Each names the transfer that it belongs to, for a
// Worker takes part in any number of transfers at once.
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

/// A transfer, unique within the run.
enum class TransferId : std::uint64_t {};

/// The two sides of a collision, as models.
inline constexpr collide::ModelId source_model{1};
inline constexpr collide::ModelId target_model{2};

/// What begins a transfer at all Workers of both meshes.
struct TransferSetup {
  TransferId id{};
  collide::Collider collider;
  ArrayProxy<Worker> source;
  ArrayProxy<Worker> target;
};

/// The part of a mesh that a Worker carries, with its values.
struct PartLoad {
  MeshPart part;
  std::uint64_t n_components = 0;
  std::vector<double> values;  ///< part.points.size() × n_components, row-major
};

/// Questions of one target Worker to one source Worker.
struct Query {
  TransferId transfer{};
  Index1 from;                     ///< the target Worker
  std::vector<std::int32_t> rows;  ///< of its points; parallel to points
  std::vector<Point> points;
  std::vector<PointPair> pairs;  ///< (tetrahedron of the source Worker, index into points)
};

/// The best claim of one source Worker for each point that it holds.
struct Answer {
  TransferId transfer{};
  std::vector<std::int32_t> rows;
  std::vector<Candidate> claims;
  std::vector<double> values;  ///< rows.size() × n_components, row-major
};

/// Which vertices are nearest to some points: asked of one source Worker.
struct NearestQuery {
  TransferId transfer{};
  Index1 from;
  std::vector<std::int32_t> rows;
  std::vector<Point> points;
  std::vector<double> squared_reaches;  ///< of each point: what is farther does not matter
};
/// The nearest vertices of one source Worker; vertex -1 where none is within reach.
struct NearestAnswer {
  TransferId transfer{};
  std::vector<std::int32_t> rows;  ///< those of the query
  std::vector<double> squared_distances;
  std::vector<GlobalId> vertices;
  std::vector<double> values;  ///< rows.size() × n_components, row-major
};

/// What vertices outside get.
struct Settlement {
  TransferId transfer{};
  OutsidePolicy policy;
  std::vector<Aabb> source_boxes;  ///< of the source's parts, where the policy is Nearest
};

/// New values of vertices that another Worker owns.
struct GhostRows {
  TransferId transfer{};
  std::vector<std::int32_t> rows;  ///< of the receiver
  std::vector<double> values;      ///< rows.size() × n_components, row-major
};

/// How many vertices of a target have each Status, and how many candidates were looked at.
struct Tally {
  std::array<std::uint64_t, 4> counts{};
  std::uint64_t n_candidates = 0;
};
/// Adds tallies; for reductions.
struct AddTallies {
  Tally operator()(Tally a, const Tally& b) const {
    for (std::size_t s = 0; s < a.counts.size(); ++s) a.counts[s] += b.counts[s];
    a.n_candidates += b.n_candidates;
    return a;
  }
};

/// What a Worker knows of the vertices it owns, for whoever gathers it. Before the first transfer
/// into the mesh every vertex has the status `outside`.
struct Outcome {
  std::vector<GlobalId> points;
  std::vector<Status> status;  ///< by the transfer into the mesh that ended last
  std::vector<double> values;  ///< points.size() × n_components, row-major
};
/// Joins outcomes; for reductions.
struct JoinOutcomes {
  Outcome operator()(Outcome a, const Outcome& b) const;
};

}  // namespace tess::m2m
