#include "apps/m2m_transfer/output/rows.hpp"

#include "apps/m2m_transfer/output/found.hpp"

namespace m2m_transfer {
namespace {

/// Null if no vertex was found.
kit::Json of_found(const FieldRow& row, double ErrorNorms::*norm) {
  const ErrorNorms& found = row.field->found;
  return found.n_vertices == 0 ? kit::Json() : kit::Json(found.*norm);
}
/// A count of conservative kinds; null for others.
template <class T>
kit::Json of_covers(const FieldRow& row, T Tally::*count) {
  return row.report->kind.starts_with("conservative") ? kit::Json(row.report->tally.*count)
                                                      : kit::Json();
}
/// The seconds of the fastest search after a motion; null without one.
kit::Json seconds_again(const FieldRow& row) {
  return row.report->searches > 1 ? kit::Json(row.report->seconds.again) : kit::Json();
}
template <std::size_t status>
kit::Json count_of(const FieldRow& row) {
  return row.report->tally.counts[status];
}

}  // namespace

std::vector<FieldRow> rows_of(const std::vector<TransferReport>& reports) {
  std::vector<FieldRow> rows;
  for (const TransferReport& report : reports)
    for (const FieldError& field : report.fields) rows.push_back({&report, &field});
  return rows;
}

const kit::Rows<FieldRow>& field_rows() {
  using R = const FieldRow&;
  using kit::Json;
  static constexpr kit::Column<FieldRow> columns[] = {
      {"kind", "kind", "<", [](R r) -> Json { return r.report->kind; }},
      {"policy", "policy", "<", [](R r) -> Json { return r.report->policy; }},
      {"source", "source", "<", [](R r) -> Json { return r.report->source; }},
      {"target", "target", "<", [](R r) -> Json { return r.report->target; }},
      {"source_edge", "edge", "6.4g", [](R r) -> Json { return r.report->source_edge; }},
      {"source_tets", "", nullptr, [](R r) -> Json { return r.report->source_tets; }},
      {"targets", "", nullptr, [](R r) -> Json { return r.report->targets; }},
      {"inside", "", nullptr, count_of<0>},
      {"boundary", "", nullptr, count_of<1>},
      {"snapped", "", nullptr, count_of<2>},
      {"outside", "outside", "7", count_of<3>},
      {"overcovered", "", nullptr, [](R r) { return of_covers(r, &Tally::n_overcovered); }},
      {"most_covered", "", nullptr, [](R r) { return of_covers(r, &Tally::most_covered); }},
      {"linear", "", nullptr, [](R r) -> Json { return r.report->tally.n_linear; }},
      {"field", "field", "<", [](R r) -> Json { return r.field->name; }},
      {"l2", "L2", "10.4e", [](R r) -> Json { return r.field->norms.l2; }},
      {"l2_relative", "relative", "10.4e", [](R r) -> Json { return r.field->norms.l2_relative; }},
      {"rms", "", nullptr, [](R r) -> Json { return r.field->norms.rms; }},
      {"linf", "Linf", "10.4e", [](R r) -> Json { return r.field->norms.linf; }},
      {"found", "", nullptr, [](R r) -> Json { return r.field->found.n_vertices; }},
      {"l2_found", "L2 found", "10.4e", [](R r) { return of_found(r, &ErrorNorms::l2); }},
      {"l2_relative_found", "", nullptr, [](R r) { return of_found(r, &ErrorNorms::l2_relative); }},
      {"rms_found", "", nullptr, [](R r) { return of_found(r, &ErrorNorms::rms); }},
      {"linf_found", "Linf found", "10.4e", [](R r) { return of_found(r, &ErrorNorms::linf); }},
      {"integral_source", "", nullptr, [](R r) -> Json { return r.field->source_integral; }},
      {"integral_target", "", nullptr, [](R r) -> Json { return r.field->target_integral; }},
      {"", "integral", "9.2e",
       [](R r) -> Json { return r.field->target_integral - r.field->source_integral; }},
      {"candidates", "", nullptr, [](R r) -> Json { return r.report->tally.n_candidates; }},
      {"read_seconds", "", nullptr, [](R r) -> Json { return r.report->seconds.read; }},
      {"setup_seconds", "setup, s", "8.4f", [](R r) -> Json { return r.report->seconds.setup; }},
      {"broad_seconds", "", nullptr, [](R r) -> Json { return r.report->seconds.broad; }},
      {"narrow_seconds", "", nullptr, [](R r) -> Json { return r.report->seconds.narrow; }},
      {"apply_seconds", "apply, s", "8.4f", [](R r) -> Json { return r.report->seconds.apply; }},
      {"transfer_seconds", "transfer, s", "8.4f",
       [](R r) -> Json { return r.report->seconds.transfer(); }},
      {"gather_seconds", "", nullptr, [](R r) -> Json { return r.report->seconds.gather; }},
      {"search_again_seconds", "", nullptr, seconds_again},
      {"searches", "", nullptr, [](R r) -> Json { return r.report->searches; }},
      {"kept_sources", "", nullptr, [](R r) -> Json { return r.report->tally.n_kept_sources; }},
      {"peak_memory_bytes", "", nullptr,
       [](R r) -> Json { return r.report->footprint.peak_memory_bytes; }},
      {"peak_memory_bytes_greatest", "", nullptr,
       [](R r) -> Json { return r.report->footprint.greatest_peak_memory_bytes; }},
      {"bytes_sent", "", nullptr, [](R r) -> Json { return r.report->footprint.bytes_sent; }},
      {"pes", "", nullptr, [](R r) -> Json { return r.report->pes; }},
      {"processes", "", nullptr, [](R r) -> Json { return r.report->processes; }},
      {"chares", "", nullptr, [](R r) -> Json { return r.report->chares; }},
      {"voxel", "", nullptr, [](R r) -> Json { return r.report->voxel; }},
      {"elements", "", nullptr,
       [](R r) { return json_of(r.report->source_elements, r.report->target_elements); }},
      {"farthest", "", nullptr, [](R r) { return json_of(r.report->worst); }},
      {"result_hash", "result", "16", [](R r) -> Json { return kit::hex(r.report->result_hash); }}};
  static const kit::Rows<FieldRow> rows(columns);
  return rows;
}

kit::Json definitions() {
  return {{"e", "value - truth at a vertex of the target"},
          {"l2", "sqrt(sum m e^2); m: a quarter of the volume of the vertex's tetrahedra"},
          {"l2_relative", "l2 / sqrt(sum m truth^2)"},
          {"rms", "sqrt(mean e^2)"},
          {"linf", "max |e|"},
          {"integral",
           "of the field by the row sums of the mass matrix, over the source and the target"},
          {"all",
           "sums, mean and maximum over all vertices; vertices outside have the values of the "
           "policy"},
          {"found", "the same over vertices that are inside, boundary or snapped"}};
}

}  // namespace m2m_transfer
