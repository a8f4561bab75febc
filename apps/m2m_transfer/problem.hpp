// The input of one transfer, read and checked: two meshes, the manufactured fields on both, the
// policy, the number of chares and the voxel size. Only PE 0 reads files and holds a Problem.
#pragma once

#include "apps/m2m_transfer/report.hpp"
#include "m2m/field.hpp"
#include "m2m/mesh.hpp"
#include "m2m/partition_method.hpp"
#include "m2m/policy.hpp"
#include "m2m/transfer_kind.hpp"
#include "runtime/machine/machine.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace m2m_transfer {

/// The options of a transfer, as on the command line.
struct Request {
  std::string source{}, target{};
  std::vector<std::string> fields{"gaussian"};
  std::string policy = "keep";
  std::string partition = "rcb";
  std::string kind = "linear";
  std::int32_t n_chares = 0;  ///< per mesh; 0: per_pe times the number of PEs
  std::int32_t per_pe = 8;
  double voxel = 0;         ///< edge; 0: chosen by the collider
  std::int32_t repeat = 1;  ///< number of transfers; the fastest counts
  std::int32_t steps = 1;   ///< applications of each; the fastest counts
};

struct Problem {
  TetMesh source{}, target{};
  MeshCensus source_census{}, target_census{};
  std::vector<Field> source_fields{}, target_fields{};
  std::vector<Field> truth{};  ///< on the target
  OutsidePolicy policy{};
  PartitionMethod partition{};
  TransferKind kind{};
  Point voxel{};
  std::int32_t repeat = 1, steps = 1;
  TransferReport report{};  ///< load() fills in what is known before the run
};

/// Reads the meshes and samples the fields. Throws Error with the option or file that is wrong.
[[nodiscard]] Problem load(const Request& request, const Machine& machine);

}  // namespace m2m_transfer
