#include "apps/m2m_transfer/explain.hpp"

#include <fmt/format.h>

namespace m2m_transfer {
namespace {

std::string mesh_line(const char* side, const TetMesh& mesh, const MeshCensus& census) {
  std::string line =
      fmt::format("  {}: {} vertices, {} tetrahedra", side, mesh.n_points(), mesh.n_tets());
  if (census.n_flat != 0) line += fmt::format(", {} of them flat", census.n_flat);
  if (census.n_inverted != 0) line += fmt::format(", {} inverted", census.n_inverted);
  if (census.n_unused != 0) line += fmt::format(", {} vertices unused", census.n_unused);
  return line + '\n';
}

}  // namespace

std::string explain(const Problem& problem, Output output) {
  const TransferReport& r = problem.report;
  std::string out = "this transfer uses\n";
  out += mesh_line("source", problem.source, problem.source_census);
  out += mesh_line("target", problem.target, problem.target_census);
  const std::size_t n_fields = problem.source_fields.size();
  out += fmt::format("  {} {} of one component{}\n", n_fields, n_fields == 1 ? "field" : "fields",
                     n_fields == 1 ? "" : ", located once for all fields");
  if (r.chares > 1)
    out +=
        fmt::format("  Zoltan, which cuts each mesh into {} chares on {} PEs\n", r.chares, r.pes);
  out += "  covers of some dozens of tetrahedra or vertices each, whose boxes meet in voxels";
  out += problem.voxel[0] == 0 ? "\n" : fmt::format(" with edges of {:.4g}\n", problem.voxel[0]);
  if (std::holds_alternative<Nearest>(problem.policy))
    out += "  the search for the nearest source vertex, for each vertex outside\n";
  if (problem.kind != TransferKind::linear)
    out +=
        "  recovered gradients at the donors' vertices, from two layers of tetrahedra around a "
        "chare\n";
  if (output == Output::mesh) out += "  ExodusII output\n";

  out += "it leaves out\n";
  out += "  voxels in empty space, and the search in voxels that only one of the meshes touches\n";
  out += "  pairs within a mesh, and tetrahedra whose cover has no vertex near\n";
  out += "  the search in further steps (--steps): the donors are kept\n";
  if (r.chares == 1) out += "  partitioning: each mesh is one chare\n";
  if (r.processes == 1) out += "  serialisation: within a process messages are moved, not packed\n";
  if (!std::holds_alternative<Nearest>(problem.policy))
    out += "  the search for nearest vertices (--policy nearest)\n";
  if (problem.kind == TransferKind::linear)
    out += "  recovered gradients and halos (--kind second-order)\n";
  if (output == Output::report) out += "  writing a mesh (--out)\n";
  if (!overlap(problem.source_census.bounds, problem.target_census.bounds,
               tess::collide::Touching::counts))
    out += "the bounding boxes of the meshes do not overlap: every vertex will be outside\n";
  return out;
}

}  // namespace m2m_transfer
