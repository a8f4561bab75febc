// The report of a transfer, as a table and as JSON.
#pragma once

#include "apps/m2m_transfer/footprint.hpp"
#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace m2m_transfer {

/// Wall-clock seconds of the phases. `read`: on PE 0; `setup`: partition and distribution; `broad` and
/// `narrow`: the search; `apply`: one application of the donors found.
struct PhaseSeconds {
  double read = 0, setup = 0, broad = 0, narrow = 0, apply = 0;
  [[nodiscard]] double transfer() const { return broad + narrow + apply; }
};

/// The error of one field.
struct FieldError {
  std::string name;
  ErrorNorms norms;  ///< over all vertices of the target
  ErrorNorms found;  ///< over the vertices that are not outside
};

struct TransferReport {
  std::string source, target, policy, kind, machine;
  std::string source_skipped, target_skipped;  ///< elements without volume: "120 TRI3"
  std::string source_split, target_split;      ///< elements cut: "27 HEX8 into 162 tetrahedra"
  std::int32_t pes = 0, processes = 0, chares = 0;
  std::size_t source_tets = 0, targets = 0;
  double source_edge = 0;                 ///< of a cube with the volume of six average tetrahedra
  std::array<std::uint64_t, 4> counts{};  ///< per Status
  std::vector<FieldError> fields;
  Point worst_at{};  ///< the vertex with the largest error of the first field
  std::uint64_t n_candidates = 0;
  double voxel = 0;
  PhaseSeconds seconds;
  Footprint footprint;  ///< bytes_sent: by setup and one transfer
  std::uint64_t result_hash = 0;
};

[[nodiscard]] std::string table(const TransferReport& report);
/// {"definitions": {…}, "pairs": [{…}]}
[[nodiscard]] std::string json(const std::vector<TransferReport>& reports);

}  // namespace m2m_transfer
