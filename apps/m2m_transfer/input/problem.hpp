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
#include "m2m/status.hpp"
#include "m2m/transfer_kind.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace m2m_transfer {

/// The options of a run, as on the command line.
struct Request {
  std::string source{}, target{};
  std::string source_part{}, target_part{};  ///< as for surface_of(); empty: the whole mesh
  std::vector<std::string> more{};           ///< further meshes
  std::string pairs{};                       ///< "A:B,B:C"; empty: source to target
  std::vector<std::string> fields{"gaussian"};
  std::string policy = "keep";
  std::string partition = "curve";
  std::string kind = "linear";
  std::int32_t n_chares = 0;  ///< per mesh; 0: per_pe times the number of PEs
  std::int32_t per_pe = 8;
  double voxel = 0;         ///< edge; 0: chosen by the collider
  double tolerance = 0;     ///< length within which vertices snap to the source
  bool clamp = false;       ///< keep values within those of the donor
  std::int32_t order = 1;   ///< of moving least squares
  std::int32_t repeat = 1;  ///< number of transfers; the fastest counts
  std::int32_t steps = 1;   ///< applications of each; the fastest counts
  std::vector<std::string> moves{};

  /// Per mesh. In a run.
  [[nodiscard]] std::int32_t chares() const;
};

/// A mesh of a run. PE 0 holds it only if it has to: if Zoltan cuts it, if the file cannot be read
/// in ranges, or if it is a part; and, after a run whose result is written or drawn, if a pair wrote it
/// (bring_targets()).
struct RunMesh {
  std::string name{};  ///< once it is read, with the part
  std::string part{};  ///< as for surface_of(); empty: the whole mesh
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
  std::int32_t order = 1;
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

/// The largest second derivative in any direction, max |D²f|, of a field of make_formula(); empty
/// for expressions.
[[nodiscard]] std::optional<double> largest_second_derivative(const std::string& field,
                                                              const Aabb& domain);

/// A bound of the error of linear interpolation in tetrahedra whose edges are at most `longest`:
/// (3/16) h² max |D²f|. The error is at most R²/2 max |D²f|, where R is the radius of the smallest
/// ball that holds the tetrahedron (Waldron 1998, theorem 3.1), and R² is at most 3/8 h² (Jung 1901).
[[nodiscard]] constexpr double linear_bound(double longest, double second_derivative) {
  return 3.0 / 16 * longest * longest * second_derivative;
}

/// The status of target vertices as a field for output, "status": 0 inside, 1 boundary, 2 snapped,
/// 3 outside. Its name begins with "transfer_" if one of the fields that are written with it is a
/// "status" too.
[[nodiscard]] inline Field status_field(std::span<const Status> status,
                                        std::span<const Field> others) {
  std::vector<double> values;
  for (const Status s : status) values.push_back(static_cast<double>(s));
  std::string name = "status";
  while (std::ranges::find(others, name, &Field::name) != others.end()) name.insert(0, "transfer_");
  return {name, 1, std::move(values)};
}

}  // namespace m2m_transfer
