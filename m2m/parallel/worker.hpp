// A part of a mesh with the values at its vertices, as a chare. It takes part in any number of
// transfers at once, as source, as target or as both; each has a state of its own here, keyed by
// its TransferId, from its begin to its end. The steps of one transfer, an epoch each:
//
//   broad    both sides submit boxes; voxels report candidates (vertex, tetrahedron) to the target
//   narrow   a target Worker asks each source Worker that has candidates, in one message; the
//            source Worker decides, interpolates, and answers with its best claim of each point
//   settle   vertices outside get their values by the policy
//   share    new values go to the other Workers that hold the vertices as ghosts
//   end      the target takes the new values over; both sides forget the transfer
//
// Begin and end are broadcasts, which all Workers of a mesh meet in one order. A transfer reads the
// values that its source has at its begin, and its target's values change at its end alone: so a
// transfer reads another one's result wholly or not at all. Claims are merged by a total order
// (candidate.hpp): the answer depends on no order of arrival.
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

  // Broad phase: the begin.
  void submit_tets(const TransferSetup& setup);
  void submit_points(const TransferSetup& setup);
  void receive_hits(TransferId transfer, collide::Hits hits);

  // Narrow phase.
  void ask_sources(TransferId transfer);
  void answer(Query query);
  void receive_answer(const Answer& answer);

  // Policy.
  void settle(const Settlement& settlement);
  void answer_nearest(NearestQuery query);
  void receive_nearest(const NearestAnswer& answer);

  // The end.
  void share(TransferId transfer);
  void receive_ghosts(const GhostRows& ghosts);
  void take_over(TransferId transfer, Callback<Tally> tally);
  void forget(TransferId transfer);

  /// Gives its vertices and values to a reduction.
  void gather(Callback<Outcome> target);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(part_, n_components_, values_, status_, outgoing_, incoming_);
  }

 private:
  /// A transfer that reads this part.
  struct Outgoing {
    TransferSetup setup;
    std::optional<std::vector<double>> values{};  // those of its begin, once the part's changed
  };
  /// The nearest vertex known so far of a point outside, and the part asked last.
  struct NearestClaim {
    double squared_distance = std::numeric_limits<double>::infinity();
    GlobalId vertex = std::numeric_limits<GlobalId>::max();
    NearestParts::Part asked{};
  };
  /// A transfer that writes to this part.
  struct Incoming {
    TransferSetup setup;
    std::vector<collide::Hits> hits{};
    std::uint64_t n_candidates = 0;
    std::vector<Candidate> claims{};      // the best so far of each owned point
    std::vector<NearestClaim> nearest{};  // of each owned point, where one is outside
    NearestParts nearest_parts{};
    std::vector<double> values{};        // new rows of all points, where they are new
    std::vector<std::uint8_t> is_new{};  // of each point
  };

  [[nodiscard]] Outgoing& outgoing(TransferId transfer);
  [[nodiscard]] Incoming& incoming(TransferId transfer);
  [[nodiscard]] double* row(std::vector<double>& values, std::int32_t point) const {
    return values.data() + static_cast<std::size_t>(point) * n_components_;
  }
  /// Asks for each of these points the next part that may hold a nearer vertex, if there is one.
  void ask_nearest(Incoming& to, std::span<const std::int32_t> rows);
  /// Sets the new row of a point.
  void put(Incoming& to, std::int32_t point, const double* values) const;

  MeshPart part_;
  std::uint64_t n_components_ = 0;
  std::vector<double> values_;  // of all points, row-major
  std::vector<Status> status_;  // of each owned point
  std::map<TransferId, Outgoing> outgoing_;
  std::map<TransferId, Incoming> incoming_;
  std::optional<NearestVertex> nearest_;  // of owned points; made when first asked for, again after
                                          // a migration
};

/// collide::Hits of a collision go to the Workers of a target, under a transfer's id.
[[nodiscard]] Callback<collide::Hits> report_to_target(ArrayProxy<Worker> target,
                                                       TransferId transfer);

}  // namespace tess::m2m
