#include "apps/m2m_transfer/output/table.hpp"

#include "apps/m2m_transfer/output/farthest.hpp"
#include "apps/m2m_transfer/output/found.hpp"
#include "m2m/transfer_kind.hpp"

#include <array>
#include <fmt/core.h>

namespace m2m_transfer {
namespace {

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / 1e6;
}

kit::Json norms_of(const ErrorNorms& norms) {
  return {{"l2", norms.l2},
          {"l2_relative", norms.l2_relative},
          {"rms", norms.rms},
          {"linf", norms.linf}};
}

/// The meaning of a number of the report.
struct Definition {
  const char* name;
  const char* meaning;
};
constexpr std::array definitions{
    Definition{"e", "value - truth at a vertex of the target"},
    Definition{"l2", "sqrt(sum m e^2); m: a quarter of the volume of the vertex's tetrahedra"},
    Definition{"l2_relative", "l2 / sqrt(sum m truth^2)"},
    Definition{"rms", "sqrt(mean e^2)"},
    Definition{"linf", "max |e|"},
    Definition{"integral",
               "of the field by the row sums of the mass matrix, over the source and the target"},
    Definition{
        "all",
        "sums, mean and maximum over all vertices; vertices outside have the values of the policy"},
    Definition{"found", "the same over vertices that are inside, boundary or snapped"}};

/// {"vertices": n, "l2": …}; null if no vertex was found.
kit::Json found_of(const ErrorNorms& norms) {
  if (norms.n_vertices == 0) return nullptr;
  auto out = norms_of(norms);
  out["vertices"] = norms.n_vertices;
  return out;
}

kit::Json pair_of(const TransferReport& r) {
  kit::Json pair;
  pair["source"] = r.source;
  pair["target"] = r.target;
  pair.update(json_of(r.source_elements, r.target_elements));
  pair["targets"] = r.targets;
  pair["inside"] = r.tally.counts[0];
  pair["boundary"] = r.tally.counts[1];
  pair["snapped"] = r.tally.counts[2];
  pair["outside"] = r.tally.counts[3];
  if (is_conservative(parse_transfer_kind(r.kind))) {
    pair["overcovered"] = r.tally.n_overcovered;
    pair["most_covered"] = r.tally.most_covered;
  }
  pair["farthest"] = json_of(r.worst);
  pair.update(norms_of(r.fields.front().norms));
  pair["found"] = found_of(r.fields.front().found);
  pair["candidates"] = r.tally.n_candidates;
  pair["seconds"] = {{"read", r.seconds.read},    {"setup", r.seconds.setup},
                     {"broad", r.seconds.broad},  {"narrow", r.seconds.narrow},
                     {"apply", r.seconds.apply},  {"transfer", r.seconds.transfer()},
                     {"gather", r.seconds.gather}};
  if (r.searches > 1) pair["seconds"]["search_again"] = r.seconds.again;
  pair["searches"] = r.searches;
  pair["kept_sources"] = r.tally.n_kept_sources;
  pair["peak_memory_bytes"] = r.footprint.peak_memory_bytes;
  pair["peak_memory_bytes_greatest"] = r.footprint.greatest_peak_memory_bytes;
  pair["bytes_sent"] = r.footprint.bytes_sent;
  pair["result_hash"] = fmt::format("{:016x}", r.result_hash);
  pair["policy"] = r.policy;
  pair["kind"] = r.kind;
  pair["source_tets"] = r.source_tets;
  pair["source_edge"] = r.source_edge;
  pair["machine"] = r.machine;
  pair["pes"] = r.pes;
  pair["processes"] = r.processes;
  pair["chares"] = r.chares;
  pair["voxel"] = r.voxel;
  pair["fields"] = kit::Json::array();
  for (const FieldError& field : r.fields) {
    kit::Json of_field{{"name", field.name}};
    of_field.update(norms_of(field.norms));
    of_field["integral"] = {{"source", field.source_integral}, {"target", field.target_integral}};
    of_field["found"] = found_of(field.found);
    pair["fields"].push_back(std::move(of_field));
  }
  return pair;
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

kit::Json json_of(const std::vector<TransferReport>& reports) {
  kit::Json whole;
  for (const Definition& d : definitions) whole["definitions"][d.name] = d.meaning;
  whole["pairs"] = kit::Json::array();
  for (const TransferReport& report : reports) whole["pairs"].push_back(pair_of(report));
  return whole;
}

std::string json(const std::vector<TransferReport>& reports) {
  return kit::json_text(json_of(reports));
}

}  // namespace m2m_transfer
