// A chare that holds one part of a mesh that the library has cut, and the values at its vertices.
// It is a Piece like those of an application, and updates its ghosts itself.
//
// An application of a coupling changes the values in a second step, commit(), which is a broadcast
// as the start is; all Workers of a mesh receive broadcasts in the same order. So a coupling sees
// the result of another one completely or not at all.
#pragma once

#include "m2m/couple/piece.hpp"
#include "m2m/mesh/partition/split.hpp"
#include "m2m/mesh/workers/norm_sums.hpp"
#include "m2m/mesh/workers/value_keeper.hpp"
#include "m2m/rigid_motion.hpp"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace tess::m2m {

/// The part of a mesh that a Worker holds, with its values.
struct PartLoad {
  MeshPart part;
  std::uint64_t n_components = 0;
  std::vector<double> values;  ///< part.points.size() × n_components, row-major
};

/// New values for the ghosts that a Worker holds.
struct GhostRows {
  CouplingId coupling{};
  std::vector<std::int32_t> rows;  ///< of the receiver
  std::vector<double> values;      ///< rows.size() × n_components, row-major
};

/// The status of ghosts that a Worker holds.
struct GhostStatus {
  std::vector<std::int32_t> rows;  ///< of the receiver
  std::vector<Status> status;
};

/// The vertices that a Worker owns, with status and values, as gathered from a mesh. Before the
/// first transfer into the mesh every status is `outside`.
struct Outcome {
  std::vector<GlobalId> points;
  std::vector<Status> status;    ///< per vertex, from the transfer into the mesh that ended last
  std::vector<double> values;    ///< points.size() × n_components, row-major
  std::vector<double> distance;  ///< per vertex, from the same (Piece::distance())
};
/// Joins outcomes in a reduction.
struct JoinOutcomes {
  Outcome operator()(Outcome a, const Outcome& b) const;
};

class Worker : public Chare<Worker, Index1>, public Piece<Worker> {
 public:
  void load(PartLoad load);
  /// Moves the points, ghosts included. Couplings of the mesh search again after it.
  void move(const RigidMotion& motion);

  [[nodiscard]] MeshView mesh_view() const;
  [[nodiscard]] std::span<const double> values() const { return values_; }
  /// New values of the points owned, until commit().
  [[nodiscard]] std::span<double> pending(CouplingId coupling);
  /// Sends new values to the ghosts.
  void received(CouplingId coupling);

  void receive_ghosts(const GhostRows& ghosts);
  void commit(CouplingId coupling);
  /// Contributes the owned vertices with their values to a reduction.
  void gather(Callback<Outcome> target);

  /// Sends the status of owned points to their ghosts, for measure().
  void share_status();
  void receive_status(const GhostStatus& ghosts);
  /// Contributes the part's sums to the norms of the mesh (field_norms.hpp).
  void measure(const NormsRequest& request, Callback<NormSums> target);
  /// Writes its tetrahedra, with values and status after share_status(), to the file STEM.K.vtu,
  /// where K is its index. `names`: of the components, then of the status (write_pvtu.hpp).
  void write_part(const std::string& stem, const std::vector<std::string>& names);
  /// Sends the values of owned points to the keepers of `n_vertices` of the mesh.
  void send_values(GroupProxy<ValueKeeper> keepers, GlobalId n_vertices);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_, n_components_, values_, status_, distance_, ghost_status_, pending_);
  }

 private:
  struct Pending {
    std::vector<double> values{};        // rows of all points; valid where is_new
    std::vector<std::uint8_t> is_new{};  // per point
    template <class Ar>
    void serialize(Ar& ar) {
      ar(values, is_new);
    }
  };
  [[nodiscard]] Pending& pending_of(CouplingId coupling);

  MeshPart part_;
  std::uint64_t n_components_ = 0;
  std::vector<double> values_;        // of all points, row-major
  std::vector<Status> status_;        // per owned point
  std::vector<double> distance_;      // per owned point
  std::vector<Status> ghost_status_;  // per ghost, after share_status()
  std::map<CouplingId, Pending> pending_;
};

}  // namespace tess::m2m
