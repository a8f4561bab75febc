// The input of a run, read and checked: meshes, the pairs that transfer, manufactured fields, the
// policy, the number of chares and the voxel size. Only PE 0 holds a Problem.
#pragma once

#include "apps/m2m_transfer/input/graph.hpp"
#include "apps/m2m_transfer/input/motion.hpp"
#include "apps/m2m_transfer/report.hpp"
#include "m2m/field.hpp"
#include "m2m/mesh.hpp"
#include "m2m/partition_method.hpp"
#include "m2m/placement.hpp"
#include "m2m/policy.hpp"
#include "m2m/transfer_kind.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace m2m_transfer {

/// The options of a run, as on the command line.
struct Request {
  std::string source{}, target{};
  std::vector<std::string> more{};  ///< further meshes
  std::string pairs{};              ///< "A:B,B:C"; empty: source to target
  std::vector<std::string> fields{"gaussian"};
  std::string policy = "keep";
  std::string partition = "curve";
  std::string kind = "linear";
  std::int32_t n_chares = 0;  ///< per mesh; 0: per_pe times the number of PEs
  std::int32_t per_pe = 8;
  double voxel = 0;         ///< edge; 0: chosen by the collider
  double tolerance = 0;     ///< length within which vertices snap to the source
  bool clamp = false;       ///< keep values within those of the donor
  std::int32_t repeat = 1;  ///< number of transfers; the fastest counts
  std::int32_t steps = 1;   ///< applications of each; the fastest counts
  std::vector<std::string> moves{};

  /// Per mesh. In a run.
  [[nodiscard]] std::int32_t chares() const;
};

/// A mesh of a run. PE 0 holds it only if it has to: if Zoltan cuts it, or the file cannot be read
/// in ranges; and, after a run whose result is written or drawn, if a pair wrote it
/// (bring_targets()).
struct RunMesh {
  std::string name{};
  MeshSurvey survey{};
  std::optional<TetMesh> mesh{};  ///< with the points where they were at the start
  /// What the mesh starts with, if Zoltan cuts it. After a run that collects its results
  /// (Problem::collects) a mesh that a pair writes has these, and a field "status".
  std::vector<Field> fields{};
  std::vector<StepMotion> motions{};
  /// After a run that collects its results: of the points from where they were at the start, and
  /// from there to where the formulas hold.
  std::vector<RigidMotion> made{}, back{};
};

struct Problem {
  std::vector<RunMesh> meshes{};
  std::vector<Pair> pairs{};
  std::vector<std::string> field_names{};
  std::vector<Formula> formulas{};  ///< per field
  Aabb domain{};                    ///< of the formulas: the bounds of the first source
  OutsidePolicy policy{};
  PartitionMethod partition{};
  TransferKind kind{};
  Point voxel{};
  double tolerance = 0;
  bool clamp = false;
  bool collects = false;     ///< bring all results to PE 0, to write or draw them
  std::string parts_path{};  ///< every part writes its result beside this .pvtu file; may be empty
  std::int32_t repeat = 1, steps = 1;
  std::vector<TransferReport>
      reports{};  ///< per pair; load() fills in what is known before the run

  [[nodiscard]] RunMesh& source_of(const Pair& pair) { return meshes[pair.source]; }
  [[nodiscard]] RunMesh& target_of(const Pair& pair) { return meshes[pair.target]; }
  [[nodiscard]] const RunMesh& source_of(const Pair& pair) const { return meshes[pair.source]; }
  [[nodiscard]] const RunMesh& target_of(const Pair& pair) const { return meshes[pair.target]; }
  [[nodiscard]] std::int32_t chares() const { return reports.front().chares; }
};

/// Refuses options that the kind does not know: a conservative one has no donors. Throws Error
/// (bad_argument) with the option.
void check_kind(TransferKind kind, const Request& request);

/// Reads and checks the meshes by all PEs together where they can be read in ranges, and evaluates
/// the fields. Throws Error with the option or file that is wrong.
TaskOf<Problem> load(Request request);

/// After a run that collects its results: reads the meshes that pairs write, unless they are here,
/// and moves them as the run did.
void bring_targets(Problem& problem);

/// The layers of tetrahedra that a mesh needs around its parts, as source and as target of pairs.
[[nodiscard]] std::int32_t halo_for(TransferKind kind, std::size_t mesh,
                                    const std::vector<Pair>& pairs);

}  // namespace m2m_transfer
