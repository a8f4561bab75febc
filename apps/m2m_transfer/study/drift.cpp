#include "apps/m2m_transfer/study/drift.hpp"

#include "apps/m2m_transfer/run/steps.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <cmath>

namespace m2m_transfer {
namespace {

/// The truth of `norms` is the start.
DriftRow row_of(const std::string& field, const FieldNorms& norms) {
  const auto relative = [](double value, double whole) {
    return whole > 0 ? value / whole : value;
  };
  DriftRow row;
  row.field = field;
  row.l2_relative = norms.all.l2_relative;
  row.linf = norms.all.linf;
  row.l2_kept = relative(norms.l2, norms.truth_l2);
  row.integral = norms.integral;
  row.integral_change = relative(norms.integral - norms.truth_integral, norms.truth_magnitude);
  return row;
}

/// All counts of round trips with one kind.
Task run_kind(Problem& problem, const std::vector<std::int32_t>& trips, kit::Progress& progress,
              Drift& drift) {
  progress.phase("partition");
  std::vector<DistributedMesh> meshes = co_await place(problem);
  GraphRun graph(problem, meshes, progress);
  co_await graph.search();
  const RunMesh& start = problem.meshes.front();
  const auto n_points = start.survey.n_points;
  std::vector<FormulaField> truth;
  for (const std::string& name : problem.field_names) truth.push_back({name, problem.domain});
  std::int32_t done = 0;
  double elapsed = 0;
  for (const std::int32_t count : trips) {
    problem.steps = count - done;
    const Time begin = now();
    co_await graph.steps();
    elapsed += seconds_since(begin);
    done = count;
    const std::vector<FieldNorms> norms = co_await measure_norms(meshes.front(), start.name, truth);
    for (std::size_t f = 0; f < norms.size(); ++f) {
      DriftRow row = row_of(problem.field_names[f], norms[f]);
      const std::vector<FieldColumns> column{{f, 1}};
      row.hash = co_await hash_values(meshes.front(), n_points, column);
      row.kind = name_of(problem.kind);
      row.trips = count;
      drift.rows.push_back(std::move(row));
    }
  }
  drift.trip_seconds.push_back(elapsed / done);
  co_await graph.destroy();
  co_await destroy(meshes);
}

/// A line per kind and field.
Picture picture_of(const std::vector<DriftRow>& rows, const char* name, const char* quantity,
                   double DriftRow::*value) {
  kit::Chart chart{.title = "drift over round trips",
                   .x_label = "round trips",
                   .y_label = quantity,
                   .x_log = true,
                   .y_log = true};
  const bool several = std::ranges::any_of(
      rows, [&](const DriftRow& row) { return row.field != rows.front().field; });
  for (const DriftRow& row : rows)
    kit::add_point(chart, row.kind + (several ? ", " + row.field : ""), row.trips,
                   std::abs(row.*value));
  return {name, chart};
}

}  // namespace

std::vector<std::int32_t> parse_trips(const std::string& text) {
  std::vector<std::int32_t> trips;
  for (const std::string& word : split_at_commas(text)) {
    const auto count = parse_number<std::int32_t>(word).value_or(0);
    if (count < 1 || count > 1000000 || (!trips.empty() && count <= trips.back()))
      fail(ErrorCode::bad_argument, "--round-trips: '", text,
           "' is no list of ascending numbers from 1; give for example 1,2,5,10");
    trips.push_back(count);
  }
  return trips;
}

Task measure_drift(Request request, const std::vector<TransferKind>& kinds,
                   const std::vector<std::int32_t>& trips, kit::Progress& progress, Drift& drift) {
  request.pairs = "A:B,B:A";
  progress.phase("reading");
  Problem problem = co_await load(request);
  for (const TransferKind kind : kinds) {
    problem.kind = kind;
    co_await run_kind(problem, trips, progress, drift);
  }
}

const kit::Rows<DriftRow>& drift_rows() {
  using R = const DriftRow&;
  using kit::Json;
  using kit::of;
  static constexpr kit::Column<DriftRow> columns[] = {
      {"kind", "kind", "<", of<&DriftRow::kind>},
      {"field", "field", "<", of<&DriftRow::field>},
      {"trips", "trips", "5", of<&DriftRow::trips>},
      {"l2_relative", "L2", "10.4e", of<&DriftRow::l2_relative>},
      {"linf", "Linf", "10.4e", of<&DriftRow::linf>},
      {"l2_kept", "L2 kept", "8.5f", of<&DriftRow::l2_kept>},
      {"integral", "integral", "16.10g", of<&DriftRow::integral>},
      {"integral_change", "change", "9.2e", of<&DriftRow::integral_change>},
      {"result_hash", "result", "16", [](R r) -> Json { return kit::hex(r.hash); }}};
  static const kit::Rows<DriftRow> rows(columns);
  return rows;
}

std::vector<Picture> pictures_of(const std::vector<DriftRow>& rows) {
  return {
      picture_of(rows, "drift_l2", "relative L2 difference to the start", &DriftRow::l2_relative),
      picture_of(rows, "drift_integral", "relative change of the integral",
                 &DriftRow::integral_change)};
}

}  // namespace m2m_transfer
