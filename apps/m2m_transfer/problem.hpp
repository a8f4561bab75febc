// One transfer's input, read and checked: two meshes, the manufactured fields on both, the policy,
// and how it is cut into chares and voxels. Lives on PE 0, which alone reads files.
#pragma once

#include "apps/m2m_transfer/report.hpp"
#include "m2m/field.hpp"
#include "m2m/mesh.hpp"
#include "m2m/partition_method.hpp"
#include "m2m/policy.hpp"
#include "runtime/machine/machine.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess::m2m {

/// What to transfer, as the command line says it.
struct Request {
  std::string source{}, target{};
  std::vector<std::string> fields{"gaussian"};
  std::string policy = "keep";
  std::string partition = "rcb";
  std::int32_t n_chares = 0;  ///< of each mesh; 0: per_pe on each PE
  std::int32_t per_pe = 8;
  double voxel = 0;         ///< edge; 0: chosen from the meshes
  std::int32_t repeat = 1;  ///< transfers in a row; the fastest counts
};

struct Problem {
  TetMesh source{}, target{};
  MeshCensus source_census{}, target_census{};
  std::vector<Field> source_fields{}, target_fields{};
  std::vector<Field> truth{};  ///< on the target
  OutsidePolicy policy{};
  PartitionMethod partition{};
  Point voxel{};
  std::int32_t repeat = 1;
  TransferReport report{};  ///< with what is known before the run
};

/// Reads the meshes and samples the fields. Throws Error, naming it, for anything that cannot be
/// used.
[[nodiscard]] Problem load(const Request& request, const Machine& machine);

}  // namespace tess::m2m
