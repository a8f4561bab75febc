#include "apps/m2m_transfer/output/transfer.hpp"

#include "apps/m2m_transfer/output/found.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace m2m_transfer {
namespace {

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / 1e6;
}

std::string mesh_line(const char* side, const MeshSurvey& mesh) {
  const MeshCensus& census = mesh.census;
  std::string line = fmt::format("  {}: {} vertices, {} {}", side, mesh.n_points, mesh.n_tets,
                                 cells_of(mesh.dimension));
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

std::string table(const TransferReport& r) {
  std::string out;
  const auto line = [&out](const char* name, const std::string& value) {
    out += fmt::format("  {:<12} {}\n", name, value);
  };
  out += fmt::format("{} -> {}\n", r.source, r.target);
  line("machine", r.machine);
  const std::size_t n_chares = static_cast<std::size_t>(r.chares);
  line("chares", fmt::format("{} per mesh{}{}", r.chares,
                             n_chares <= r.source_tets
                                 ? ""
                                 : fmt::format(", {} of them without {}", n_chares - r.source_tets,
                                               cells_of(r.source_dimension)),
                             r.voxel == 0 ? "" : fmt::format(", voxels of {:.4g}", r.voxel)));
  line("vertices",
       fmt::format("{} from {} {}", r.targets, r.source_tets, cells_of(r.source_dimension)));
  for (const auto& [title, elements] : lines_of(r.source_elements, r.target_elements))
    line(title, elements);
  line("found", found_text(r.tally.counts));
  if (const std::string text = overcovered_text(r.tally); !text.empty()) line("overlaps", text);
  if (const std::string text = linear_text(r.tally); !text.empty()) line("not native", text);
  for (const std::string& place : texts_of(r.worst)) line("farthest", place);
  line("candidates",
       fmt::format("{} ({:.2f} per vertex)", r.tally.n_candidates,
                   static_cast<double>(r.tally.n_candidates) / static_cast<double>(r.targets)));
  const auto errors = [&](const std::string& title, auto&& norms_of_field) {
    out += fmt::format("  {:<26} {:>11} {:>11} {:>11} {:>11}\n", title, "L2", "relative", "RMS",
                       "Linf");
    for (const FieldError& field : r.fields) {
      const ErrorNorms norms = norms_of_field(field);
      out += fmt::format("  {:<26} {:>11.4e} {:>11.4e} {:>11.4e} {:>11.4e}\n", field.name, norms.l2,
                         norms.l2_relative, norms.rms, norms.linf);
    }
  };
  const std::size_t n_found = r.fields.front().found.n_vertices;
  if (n_found > 0 && n_found < r.targets)
    errors(fmt::format("error, {} found", n_found), [](const FieldError& f) { return f.found; });
  errors(n_found == r.targets ? fmt::format("error, {} all found", r.targets)
                              : fmt::format("error, all {}", r.targets),
         [](const FieldError& f) { return f.norms; });
  for (const FieldError& field : r.fields)
    line("integral", fmt::format("{}: {:.9g} of the source, {:.9g} of the target", field.name,
                                 field.source_integral, field.target_integral));
  line("worst at",
       fmt::format("({:.4g}, {:.4g}, {:.4g})", r.worst_at[0], r.worst_at[1], r.worst_at[2]));
  out += fmt::format("  {:<12} {:>11} {:>11} {:>11} {:>11} {:>11}\n", "seconds", "setup", "broad",
                     "narrow", "apply", "transfer");
  out += fmt::format("  {:<12} {:>11.4f} {:>11.4f} {:>11.4f} {:>11.4f} {:>11.4f}\n", "",
                     r.seconds.setup, r.seconds.broad, r.seconds.narrow, r.seconds.apply,
                     r.seconds.transfer());
  if (r.searches > 1)
    line("moved",
         fmt::format(
             "{} times; the fastest search again took {:.4f} s; the last one kept the covers "
             "of {} of {} source chares",
             r.searches - 1, r.seconds.again, r.tally.n_kept_sources, r.chares));
  line("memory",
       fmt::format("{:.1f} MB peak over {} {}, {:.1f} MB the greatest; {:.3f} MB sent between them",
                   megabytes(r.footprint.peak_memory_bytes), r.processes,
                   r.processes == 1 ? "process" : "processes",
                   megabytes(r.footprint.greatest_peak_memory_bytes),
                   megabytes(r.footprint.bytes_sent)));
  line("result", fmt::format("{:016x}", r.result_hash));
  return out;
}

std::string legend() {
  return "  with e = value - truth and m = a quarter of the volume of a vertex's tetrahedra:\n"
         "  L2 = sqrt(sum m e^2), relative = L2 / sqrt(sum m truth^2), RMS = sqrt(mean e^2),\n"
         "  Linf = max |e|; over the vertices found (inside, boundary, snapped), and over all "
         "vertices\n"
         "  (those outside have the values of the policy)\n";
}

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
