// A chare that holds one part of a mesh that the library has cut, and the values at its vertices or
// in its tetrahedra. It is a Piece like those of an application, and updates its ghosts itself.
// Its own rows are those of the vertices that it owns, or of its own tetrahedra.
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
#include "m2m/rows/reconstruct/element_corners.hpp"
#include "m2m/transfer_kind.hpp"

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
  std::vector<double> values;  ///< points of the part, or tetrahedra, × n_components; row-major
  Centring centring = Centring::nodes;
  /// With Centring::corners the values are those of the tetrahedra, and the Worker makes linear
  /// functions of them (element_corners.hpp).
  std::vector<GlobalId> elements{};
  CornerLimit limit{};
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

/// The own rows of Workers, with status and values, as gathered from a mesh. Before the first
/// transfer into the mesh every status is `outside`.
struct Outcome {
  std::vector<GlobalId> points;  ///< the vertices; tetrahedra if the values are those of cells
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
  /// New values of its own rows, until commit().
  [[nodiscard]] std::span<double> pending(CouplingId coupling);
  /// Sends new values to the ghosts.
  void received(CouplingId coupling);

  void receive_ghosts(const GhostRows& ghosts);
  void commit(CouplingId coupling);
  /// Contributes its own rows to a reduction.
  void gather(Callback<Outcome> target);

  // The following are for values at vertices.

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
    ar(couplings, part_, n_components_, centring_, values_, status_, distance_, ghost_status_,
       pending_);
  }

 private:
  struct Pending {
    std::vector<double> values{};        // all rows; valid where is_new
    std::vector<std::uint8_t> is_new{};  // per row
    template <class Ar>
    void serialize(Ar& ar) {
      ar(values, is_new);
    }
  };
  [[nodiscard]] Pending& pending_of(CouplingId coupling);
  [[nodiscard]] bool has_nodes() const { return centring_ == Centring::nodes; }
  /// The ids of its own rows.
  [[nodiscard]] std::span<const GlobalId> own_ids() const {
    const std::span<const GlobalId> all = has_nodes() ? part_.point_ids : part_.tet_ids;
    return all.first(static_cast<std::size_t>(has_nodes() ? part_.n_owned : part_.n_own_tets));
  }

  MeshPart part_;
  std::uint64_t n_components_ = 0;
  Centring centring_ = Centring::nodes;
  std::vector<double> values_;        // of all points, tetrahedra or corners, row-major
  std::vector<Status> status_;        // per own row
  std::vector<double> distance_;      // per own row
  std::vector<Status> ghost_status_;  // per ghost, after share_status()
  std::map<CouplingId, Pending> pending_;
};

}  // namespace tess::m2m
