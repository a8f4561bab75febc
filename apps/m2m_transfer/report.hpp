// What is measured of a transfer.
#pragma once

#include "apps/m2m_transfer/names.hpp"
#include "m2m/field.hpp"
#include "m2m/mesh.hpp"
#include "m2m/tally.hpp"
#include "m2m/worst_places.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace m2m_transfer {

/// Elements of a file that are not tetrahedra, and vertices without any.
struct OtherElements {
  std::string skipped{};  ///< without volume: "120 TRI3"
  std::string split{};    ///< "27 HEX8 into 162 tetrahedra"
  std::string unused{};   ///< "24 of 812 vertices belong to no element"
  /// "24 of 812 vertices have the place of another": of the source, in a transfer onto itself. Not
  /// counted if no process has the whole mesh.
  std::string coincident{};
  /// "162 of 324 tetrahedra have the corners of another": of the source, counted likewise.
  std::string repeated{};
};

/// The cost of a transfer besides time.
struct Footprint {
  std::uint64_t peak_memory_bytes = 0;           ///< sum of the peaks of all processes
  std::uint64_t greatest_peak_memory_bytes = 0;  ///< the largest of these peaks
  std::uint64_t bytes_sent = 0;                  ///< between processes since the start, by all PEs
};

/// Wall-clock seconds of the phases. `read`: reading and checking; `setup`: partition and
/// distribution; `broad` and `narrow`: the search; `again`: the fastest search after a motion, 0
/// without one; `apply`: one application of the donors found; `gather`: the values of the target,
/// collected on PE 0.
struct PhaseSeconds {
  double read = 0, setup = 0, broad = 0, narrow = 0, again = 0, apply = 0, gather = 0;
  [[nodiscard]] double transfer() const { return broad + narrow + apply; }
};

/// The error of one field.
struct FieldError {
  std::string name;
  ErrorNorms norms;               ///< over all vertices of the target
  ErrorNorms found;               ///< over the vertices that are not outside
  double source_integral = 0;     ///< of the linear interpolant over the source
  double target_integral = 0;     ///< over the target
  std::optional<double> bound{};  ///< of the Linf error of linear interpolation, if it is known
};

struct TransferReport {
  std::string source, target, policy, kind, machine;
  OtherElements source_elements, target_elements;
  std::int32_t pes = 0, processes = 0, chares = 0;
  std::size_t source_tets = 0, targets = 0;
  std::int32_t source_dimension = 3;  ///< TetMesh::dimension
  double source_edge = 0;             ///< of a cube with the volume of six average tetrahedra
  Tally tally;                        ///< of the last search
  WorstPlaces worst;                  ///< of the last search
  std::int32_t searches = 1;
  std::vector<FieldError> fields;
  Point worst_at{};  ///< the vertex with the largest error of the first field
  double voxel = 0;
  PhaseSeconds seconds;
  Footprint footprint;  ///< bytes_sent: by setup and the first transfers of all pairs
  std::uint64_t result_hash = 0;
};

}  // namespace m2m_transfer
