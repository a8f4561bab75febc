#include "apps/m2m_transfer/output/table.hpp"

#include "apps/m2m_transfer/output/farthest.hpp"
#include "apps/m2m_transfer/output/found.hpp"

#include <fmt/core.h>

namespace m2m_transfer {
namespace {

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / 1e6;
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
  line("chares",
       fmt::format("{} per mesh{}{}", r.chares,
                   n_chares <= r.source_tets ? ""
                                             : fmt::format(", {} of them without a tetrahedron",
                                                           n_chares - r.source_tets),
                   r.voxel == 0 ? "" : fmt::format(", voxels of {:.4g}", r.voxel)));
  line("vertices", fmt::format("{} from {} tetrahedra", r.targets, r.source_tets));
  for (const auto& [title, elements] : lines_of(r.source_elements, r.target_elements))
    line(title, elements);
  line("found", found_text(r.tally.counts));
  if (const std::string text = overcovered_text(r.tally); !text.empty()) line("overlaps", text);
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

}  // namespace m2m_transfer
