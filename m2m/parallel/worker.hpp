// A part of a mesh, as a chare: source and target of transfers. Steps of the slides, on account of
// one epoch each:
//
//   broad    both sides submit boxes; voxels report (vertex, tetrahedron) candidates to the
//   target's Workers narrow   a target Worker asks each source Worker concerned about its
//   candidates: points and pairs, in one message;
//            the source Worker decides, interpolates, and answers with the best claim of each point
//   settle   what lies outside gets its value by the policy
//
// Claims are merged by a total order (candidate.hpp), so the answer depends on no order of arrival.
#pragma once

#include "collide/collider.hpp"
#include "m2m/interpolate/candidate.hpp"
#include "m2m/interpolate/locate.hpp"
#include "m2m/partition/split.hpp"
#include "m2m/policy.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace tess::m2m {

class Worker;

/// The two sides of a collision, as models.
inline constexpr ModelId source_model{1};
inline constexpr ModelId target_model{2};

/// What a transfer tells its Workers.
struct TransferSetup {
  Collider collider;
  ArrayProxy<Worker> source;
  ArrayProxy<Worker> target;
  std::int32_t n_source_parts = 0;
  std::uint64_t n_components = 0;
};

/// Questions of one target Worker to one source Worker.
struct Query {
  Index1 from;                     ///< the target Worker
  std::vector<std::int32_t> rows;  ///< of its points, ascending; parallel to points
  std::vector<Point> points;
  std::vector<PointPair> pairs;  ///< (tetrahedron of the source Worker, index into points)
  template <class Ar>
  void serialize(Ar& ar) {
    ar(from, rows, points, pairs);
  }
};

/// The best claim of one source Worker for each point that it holds.
struct Answer {
  std::vector<std::int32_t> rows;
  std::vector<Candidate> claims;
  std::vector<double> values;  ///< rows.size() × n_components, row-major
  template <class Ar>
  void serialize(Ar& ar) {
    ar(rows, claims, values);
  }
};

/// The nearest source vertices of some points: asked of all source Workers.
struct NearestQuery {
  Index1 from;
  std::vector<std::int32_t> rows;
  std::vector<Point> points;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(from, rows, points);
  }
};
struct NearestAnswer {
  std::vector<std::int32_t> rows;
  std::vector<double> squared_distances;
  std::vector<GlobalId> vertices;
  std::vector<double> values;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(rows, squared_distances, vertices, values);
  }
};

/// What a Worker knows of its vertices after a transfer, for whoever gathers it.
struct Outcome {
  std::vector<GlobalId> points;
  std::vector<Status> status;
  std::vector<double> values;  ///< points.size() × n_components, row-major
  std::uint64_t n_candidates = 0;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(points, status, values, n_candidates);
  }
};
/// Joins outcomes; for reductions.
struct JoinOutcomes {
  Outcome operator()(Outcome a, const Outcome& b) const;
};

class Worker : public Chare<Worker, Index1> {
 public:
  /// Takes its part of the mesh. `values`: a row of n_components for each point of the part.
  void load(MeshPart part, std::vector<double> values);

  // Broad phase.
  void submit_tets(const TransferSetup& setup);
  void submit_points(const TransferSetup& setup);
  void receive_hits(Hits hits);

  // Narrow phase.
  void ask_sources();
  void answer(Query query);
  void receive_answer(const Answer& answer);

  // Policy.
  void settle(const OutsidePolicy& policy);
  void answer_nearest(NearestQuery query);
  void receive_nearest(const NearestAnswer& answer);

  /// Gives its vertices and values to a reduction.
  void gather(Callback<Outcome> target);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(part_, values_, setup_, hits_, claims_, nearest_, n_candidates_);
  }

 private:
  /// The nearest vertex known so far of a point outside.
  struct NearestClaim {
    double squared_distance = std::numeric_limits<double>::infinity();
    GlobalId vertex = std::numeric_limits<GlobalId>::max();
  };

  [[nodiscard]] double* row(std::int32_t point) {
    return values_.data() + static_cast<std::size_t>(point) * setup_.n_components;
  }

  MeshPart part_;
  std::vector<double> values_;  // of all points, row-major
  TransferSetup setup_;
  std::vector<Hits> hits_;
  std::vector<Candidate> claims_;      // best so far of each owned point
  std::vector<NearestClaim> nearest_;  // of each owned point, where asked
  std::uint64_t n_candidates_ = 0;
};

}  // namespace tess::m2m
