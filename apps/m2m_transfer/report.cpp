#include "apps/m2m_transfer/report.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace tess::m2m {
namespace {

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / 1e6;
}

nlohmann::ordered_json pair_of(const TransferReport& r) {
  nlohmann::ordered_json pair;
  pair["source"] = r.source;
  pair["target"] = r.target;
  pair["skipped"] = {{"source", r.source_skipped}, {"target", r.target_skipped}};
  pair["targets"] = r.targets;
  pair["inside"] = r.counts[0];
  pair["boundary"] = r.counts[1];
  pair["snapped"] = r.counts[2];
  pair["outside"] = r.counts[3];
  const ErrorNorms& first = r.fields.front().norms;
  pair["l2"] = first.l2;
  pair["l2_relative"] = first.l2_relative;
  pair["rms"] = first.rms;
  pair["linf"] = first.linf;
  pair["candidates"] = r.n_candidates;
  pair["seconds"] = {{"read", r.seconds.read},
                     {"setup", r.seconds.setup},
                     {"broad", r.seconds.broad},
                     {"narrow", r.seconds.narrow},
                     {"report", r.seconds.report},
                     {"transfer", r.seconds.transfer()}};
  pair["peak_memory_bytes"] = r.footprint.peak_memory_bytes;
  pair["peak_memory_bytes_greatest"] = r.footprint.greatest_peak_memory_bytes;
  pair["bytes_sent"] = r.footprint.bytes_sent;
  pair["result_hash"] = fmt::format("{:016x}", r.result_hash);
  pair["policy"] = r.policy;
  pair["source_tets"] = r.source_tets;
  pair["source_edge"] = r.source_edge;
  pair["machine"] = r.machine;
  pair["pes"] = r.pes;
  pair["processes"] = r.processes;
  pair["chares"] = r.chares;
  pair["voxel"] = r.voxel;
  pair["fields"] = nlohmann::ordered_json::array();
  for (const FieldError& field : r.fields)
    pair["fields"].push_back({{"name", field.name},
                              {"l2", field.norms.l2},
                              {"l2_relative", field.norms.l2_relative},
                              {"rms", field.norms.rms},
                              {"linf", field.norms.linf}});
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
  line("chares", fmt::format("{} a mesh, voxels of {:.4g}", r.chares, r.voxel));
  line("vertices", fmt::format("{} from {} tetrahedra", r.targets, r.source_tets));
  if (!r.source_skipped.empty()) line("skipped", "in the source: " + r.source_skipped);
  if (!r.target_skipped.empty()) line("skipped", "in the target: " + r.target_skipped);
  line("found",
       fmt::format("{} inside, {} boundary, {} snapped, {} outside",
                   r.counts[0],
                   r.counts[1],
                   r.counts[2],
                   r.counts[3]));
  line("candidates",
       fmt::format("{} ({:.2f} a vertex)",
                   r.n_candidates,
                   static_cast<double>(r.n_candidates) / static_cast<double>(r.targets)));
  out += fmt::format(
      "  {:<12} {:>11} {:>11} {:>11} {:>11}\n", "error", "L2", "relative", "RMS", "Linf");
  for (const FieldError& field : r.fields)
    out += fmt::format("  {:<12} {:>11.4e} {:>11.4e} {:>11.4e} {:>11.4e}\n",
                       field.name,
                       field.norms.l2,
                       field.norms.l2_relative,
                       field.norms.rms,
                       field.norms.linf);
  line("worst at",
       fmt::format("({:.4g}, {:.4g}, {:.4g})", r.worst_at[0], r.worst_at[1], r.worst_at[2]));
  out += fmt::format("  {:<12} {:>11} {:>11} {:>11} {:>11} {:>11}\n",
                     "seconds",
                     "setup",
                     "broad",
                     "narrow",
                     "report",
                     "transfer");
  out += fmt::format("  {:<12} {:>11.4f} {:>11.4f} {:>11.4f} {:>11.4f} {:>11.4f}\n",
                     "",
                     r.seconds.setup,
                     r.seconds.broad,
                     r.seconds.narrow,
                     r.seconds.report,
                     r.seconds.transfer());
  line("memory",
       fmt::format("{:.1f} MB peak over {} {}, {:.1f} MB the greatest; {:.3f} MB sent between them",
                   megabytes(r.footprint.peak_memory_bytes),
                   r.processes,
                   r.processes == 1 ? "process" : "processes",
                   megabytes(r.footprint.greatest_peak_memory_bytes),
                   megabytes(r.footprint.bytes_sent)));
  line("result", fmt::format("{:016x}", r.result_hash));
  return out;
}

std::string json(const std::vector<TransferReport>& reports) {
  nlohmann::ordered_json whole;
  whole["pairs"] = nlohmann::ordered_json::array();
  for (const TransferReport& report : reports) whole["pairs"].push_back(pair_of(report));
  return whole.dump(2) + "\n";
}

}  // namespace tess::m2m
