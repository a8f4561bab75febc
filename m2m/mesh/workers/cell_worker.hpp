// A chare that holds one part of a mesh and values in its tetrahedra (cell_transfer.hpp).
#pragma once

#include "m2m/couple/piece.hpp"
#include "m2m/mesh/partition/split.hpp"
#include "m2m/mesh/workers/worker.hpp"
#include "m2m/rows/reconstruct/element_corners.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// What a source gives: the values of its cells, or linear functions in them.
enum class CellForm : std::uint8_t { constant, linear, limited };

/// The layers around a source. `is_split`: the mesh has elements that were split.
[[nodiscard]] constexpr std::int32_t source_halo_layers(CellForm form, bool is_split) noexcept {
  return form == CellForm::constant ? 0 : element_halo_layers(is_split);
}

struct CellLoad {
  MeshPart part;
  std::vector<GlobalId> elements;  ///< per tetrahedron of the part
  std::uint64_t n_components = 0;
  std::vector<double> values;  ///< tetrahedra of the part × n_components; of a target: what it has
  CellForm form{};
  bool as_points = false;  ///< couplings see the centroids of its own tetrahedra
};

class CellWorker : public Chare<CellWorker, Index1>, public Piece<CellWorker> {
 public:
  void load(CellLoad load);

  [[nodiscard]] MeshView mesh_view() const;
  /// As CellLoad::form says: of tetrahedra, or of their corners.
  [[nodiscard]] std::span<const double> values() const { return values_; }
  /// Of its own tetrahedra.
  [[nodiscard]] std::span<double> result();
  /// Contributes its own tetrahedra with their values to a reduction.
  void gather(CouplingId coupling, const Callback<Outcome>& target);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_, n_components_, values_, as_points_, centroids_);
  }

 private:
  MeshPart part_;
  std::uint64_t n_components_ = 0;
  std::vector<double> values_;
  bool as_points_ = false;
  std::vector<Point> centroids_;  // if couplings see these
};

}  // namespace tess::m2m
