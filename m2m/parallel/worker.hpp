// A chare that holds one part of a mesh and the values at its vertices. A Worker can take part in
// several transfers at once, as source, as target or as both. It keeps a state per transfer, by
// TransferId, from the start of the transfer to its end. A transfer has five steps, one epoch each:
//
//   step     entry methods                       what happens
//   ------   ---------------------------------   -------------------------------------------------
//   broad    submit_tets, submit_points,         both meshes submit boxes; voxels report candidate
//            receive_hits                        pairs (vertex, tetrahedron) to the target
//   narrow   ask_sources, answer,                a target Worker sends one query per source Worker
//            receive_answer                      with candidates; the source Worker locates the
//                                                points, interpolates, and replies with its best
//                                                candidate per point
//   policy   resolve_outside, answer_nearest,    vertices outside get values by the policy
//            receive_nearest
//   ghosts   send_ghosts, receive_ghosts         owners send new values to the ghosts
//   end      commit, release                     the target replaces its values; both meshes drop
//                                                the state of the transfer
//
// The first and the last step are broadcasts, which all Workers of a mesh receive in the same
// order. A transfer reads the values that its source has at the start, and changes the values of
// its target only at the end. So a transfer sees the result of another one completely or not at
// all. Candidates are merged by a total order (candidate.hpp), so the result does not depend on the
// order of arrival.
#pragma once

#include "m2m/parallel/messages.hpp"
#include "m2m/search/nearest_parts.hpp"
#include "m2m/search/nearest_vertex.hpp"

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace tess::m2m {

class Worker : public Chare<Worker, Index1> {
 public:
  void load(PartLoad load);

  // Broad phase.
  void submit_tets(const TransferSetup& setup);
  void submit_points(const TransferSetup& setup);
  void receive_hits(TransferId transfer, collide::Hits hits);

  // Narrow phase.
  void ask_sources(TransferId transfer);
  void answer(Query query);
  void receive_answer(const Answer& answer);

  // Policy.
  void resolve_outside(const OutsideRequest& request);
  void answer_nearest(NearestQuery query);
  void receive_nearest(const NearestAnswer& answer);

  // Ghosts and end.
  void send_ghosts(TransferId transfer);
  void receive_ghosts(const GhostRows& ghosts);
  void commit(TransferId transfer, Callback<Tally> tally);
  void release(TransferId transfer);

  /// Contributes the owned vertices with their values to a reduction.
  void gather(Callback<Outcome> target);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(part_, n_components_, values_, status_, outgoing_, incoming_);
  }

 private:
  /// A transfer that reads this part.
  struct Outgoing {
    TransferSetup setup;
    std::optional<std::vector<double>> values{};  // at its start; set if values_ changed since
  };
  /// The nearest vertex found so far for a point outside, and the part that was asked last.
  struct NearestSoFar {
    double squared_distance = std::numeric_limits<double>::infinity();
    GlobalId vertex = std::numeric_limits<GlobalId>::max();
    NearestParts::Part asked{};
  };
  /// A transfer that writes to this part.
  struct Incoming {
    TransferSetup setup;
    std::vector<collide::Hits> hits{};
    std::uint64_t n_candidates = 0;
    std::vector<Candidate> best{};        // per owned point: the best candidate so far
    std::vector<NearestSoFar> nearest{};  // per owned point; empty if no point is outside
    NearestParts nearest_parts{};
    std::vector<double> values{};        // rows of all points; valid where is_new
    std::vector<std::uint8_t> is_new{};  // per point
  };

  [[nodiscard]] Outgoing& outgoing(TransferId transfer);
  [[nodiscard]] Incoming& incoming(TransferId transfer);
  [[nodiscard]] double* row(std::vector<double>& values, std::int32_t point) const {
    return values.data() + static_cast<std::size_t>(point) * n_components_;
  }
  /// Sends a query for each of these points to the next part that may hold a nearer vertex, if any.
  void ask_nearest(Incoming& to, std::span<const std::int32_t> rows);
  /// Sets the new values of a point.
  void set_row(Incoming& to, std::int32_t point, const double* values) const;

  MeshPart part_;
  std::uint64_t n_components_ = 0;
  std::vector<double> values_;  // of all points, row-major
  std::vector<Status> status_;  // per owned point
  std::map<TransferId, Outgoing> outgoing_;
  std::map<TransferId, Incoming> incoming_;
  // Of owned points; built on first use, and again after a migration.
  std::optional<NearestVertex> nearest_;
};

/// Sends the hits of a collision to the Workers of a target, with the transfer they belong to.
[[nodiscard]] Callback<collide::Hits> report_to_target(ArrayProxy<Worker> target,
                                                       TransferId transfer);

}  // namespace tess::m2m
