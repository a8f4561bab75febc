#include "apps/m2m_transfer/output/explain.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace m2m_transfer {
namespace {

std::string mesh_line(const char* side, const MeshSurvey& mesh) {
  const MeshCensus& census = mesh.census;
  std::string line =
      fmt::format("  {}: {} vertices, {} tetrahedra", side, mesh.n_points, mesh.n_tets);
  if (census.n_flat != 0) line += fmt::format(", {} of them flat", census.n_flat);
  if (census.n_inverted != 0) line += fmt::format(", {} inverted", census.n_inverted);
  if (census.n_unused != 0) line += fmt::format(", {} vertices unused", census.n_unused);
  return line + '\n';
}

std::string pair_text(const Pair& pair) {
  return {letter_of(pair.source), ':', letter_of(pair.target)};
}

/// "A:B A:C, then B:C"
std::string levels_text(const Problem& problem) {
  std::string out;
  for (std::size_t level = 0, n = 1; n != 0; ++level) {
    n = 0;
    for (const Pair& pair : problem.pairs) {
      if (pair.level != level) continue;
      out += n++ != 0 ? " " : level != 0 ? ", then " : "";
      out += pair_text(pair);
    }
  }
  return out;
}

bool is_moving(const Problem& problem) {
  return std::ranges::any_of(problem.meshes, [](const RunMesh& m) { return !m.motions.empty(); });
}

}  // namespace

std::string explain(const Problem& problem, Output output) {
  const TransferReport& r = problem.reports.front();
  const bool is_graph =
      problem.meshes.size() > 2 || problem.pairs.size() > 1 || problem.pairs.front().source != 0;
  std::string out = "this transfer uses\n";
  for (std::size_t m = 0; m < problem.meshes.size(); ++m) {
    const RunMesh& mesh = problem.meshes[m];
    const std::string letter(1, letter_of(m));
    out += mesh_line(is_graph ? letter.c_str() : m == 0 ? "source" : "target", mesh.survey);
  }
  if (problem.pairs.size() > 1)
    out += fmt::format("  {} pairs; those of one level at once: {}\n", problem.pairs.size(),
                       levels_text(problem));
  const std::size_t n_fields = problem.field_names.size();
  out += fmt::format("  {} {} of one component{}\n", n_fields, n_fields == 1 ? "field" : "fields",
                     n_fields == 1 ? "" : ", located once for all fields");
  if (r.chares > 1)
    out += fmt::format("  {} cuts each mesh into {} chares on {} PEs\n",
                       problem.partition == PartitionMethod::curve
                           ? "a Hilbert curve, followed by all PEs together,"
                           : "Zoltan, on one process,",
                       r.chares, r.pes);
  out += "  covers of some dozens of tetrahedra or vertices each, whose boxes meet in voxels";
  out += problem.voxel[0] == 0 ? "\n" : fmt::format(" with edges of {:.4g}\n", problem.voxel[0]);
  const bool conservative = is_conservative(problem.kind);
  const bool gradients = source_halo_layers(problem.kind) > 0;
  if (!conservative)
    out += fmt::format("  the search for the nearest source vertex, for each vertex{}\n",
                       problem.kind == TransferKind::nearest ? "" : " outside");
  if (conservative)
    out +=
        "  integrals over the intersections of tetrahedra, and a layer of tetrahedra around a "
        "chare of the target\n";
  if (gradients)
    out +=
        "  recovered gradients at the donors' vertices, from two layers of tetrahedra around a "
        "chare\n";
  if (output == Output::mesh) out += "  a mesh with the values (--out)\n";

  out += "it leaves out\n";
  out += "  voxels in empty space, and the search in voxels that only one of the meshes touches\n";
  out += "  pairs within a mesh, and tetrahedra whose cover has no vertex near\n";
  out += is_moving(problem) ? "  the search of pairs whose meshes do not move, in further steps\n"
                            : "  the search in further steps (--steps): the donors are kept\n";
  if (r.chares == 1) out += "  partitioning: each mesh is one chare\n";
  if (r.processes == 1) out += "  serialisation: within a process messages are moved, not packed\n";
  if (conservative) out += "  the search for donors and for nearest vertices\n";
  if (!gradients) out += "  recovered gradients and their halos (--kind second-order)\n";
  if (output == Output::report) out += "  writing a mesh (--out)\n";
  for (const Pair& pair : problem.pairs)
    if (!overlap(problem.source_of(pair).survey.census.bounds,
                 problem.target_of(pair).survey.census.bounds, tess::collide::Touching::counts))
      out += fmt::format("the bounding boxes of {} do not overlap: every vertex will be outside\n",
                         is_graph ? pair_text(pair) : "the meshes");
  return out;
}

}  // namespace m2m_transfer
