// What a transfer has to show: a table for people, JSON for programs.
#pragma once

#include "apps/m2m_transfer/footprint.hpp"
#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tess::m2m {

/// Seconds of the phases. Reading is PE 0's; set-up cuts the meshes and sends the parts.
struct PhaseSeconds {
  double read = 0, setup = 0, broad = 0, narrow = 0, report = 0;
  [[nodiscard]] double transfer() const { return broad + narrow + report; }
};

/// One field's distance from the truth.
struct FieldError {
  std::string name;
  ErrorNorms norms;  ///< over all vertices of the target
  ErrorNorms found;  ///< over those that are not outside
};

struct TransferReport {
  std::string source, target, policy, machine;
  std::string source_skipped, target_skipped;  ///< elements that are no volumes: "120 TRI3"
  std::int32_t pes = 0, processes = 0, chares = 0;
  std::size_t source_tets = 0, targets = 0;
  double source_edge = 0;  ///< of a cube that holds six of its tetrahedra: 1/N for kuhn:N
  std::array<std::uint64_t, 4> counts{};  ///< by Status
  std::vector<FieldError> fields;
  Point worst_at{};  ///< of the first field
  std::uint64_t n_candidates = 0;
  double voxel = 0;
  PhaseSeconds seconds;
  Footprint footprint;  ///< bytes_sent: by set-up and one transfer
  std::uint64_t result_hash = 0;
};

[[nodiscard]] std::string table(const TransferReport& report);
/// {"definitions": {…}, "pairs": [{…}]}
[[nodiscard]] std::string json(const std::vector<TransferReport>& reports);

}  // namespace tess::m2m
