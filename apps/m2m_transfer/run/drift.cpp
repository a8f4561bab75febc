#include "apps/m2m_transfer/run/drift.hpp"

#include "apps/m2m_transfer/input/formulas.hpp"
#include "apps/m2m_transfer/input/lists.hpp"
#include "apps/m2m_transfer/run/steps.hpp"
#include "runtime/core/error.hpp"

#include <cmath>

namespace m2m_transfer {
namespace {

double l2_norm(const std::vector<double>& masses, const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t v = 0; v < values.size(); ++v) sum += masses[v] * values[v] * values[v];
  return std::sqrt(sum);
}

DriftRow compare(const RunMesh& start, const std::vector<double>& masses, std::size_t field,
                 const std::vector<double>& values) {
  const std::vector<double>& before = start.fields[field].values;
  std::vector<double> magnitude, difference;
  DriftRow row;
  for (std::size_t v = 0; v < values.size(); ++v) {
    magnitude.push_back(std::abs(before[v]));
    difference.push_back(values[v] - before[v]);
    row.linf = std::max(row.linf, std::abs(difference[v]));
  }
  const auto relative = [](double value, double whole) {
    return whole > 0 ? value / whole : value;
  };
  const double norm = l2_norm(masses, before);
  row.field = start.fields[field].name;
  row.l2_relative = relative(l2_norm(masses, difference), norm);
  row.l2_kept = relative(l2_norm(masses, values), norm);
  row.integral = integral(masses, values);
  row.integral_change =
      relative(row.integral - integral(masses, before), integral(masses, magnitude));
  row.hash = result_hash(values);
  return row;
}

/// All counts of round trips with one kind.
Task run_kind(Problem& problem, const std::vector<std::int32_t>& trips, apps::Progress& progress,
              Drift& drift) {
  std::vector<DistributedMesh> meshes;
  progress.phase("partition");
  co_await place(problem, problem.kind, problem.chares(), meshes);
  GraphRun graph(problem, meshes, progress);
  co_await graph.search();
  const RunMesh& start = problem.meshes.front();
  const std::vector<double> masses = row_sums(start.mesh);
  std::int32_t done = 0;
  double elapsed = 0;
  for (const std::int32_t count : trips) {
    problem.steps = count - done;
    const Time begin = now();
    co_await graph.steps();
    elapsed += seconds_since(begin);
    done = count;
    Gathered now_there;
    co_await gather(meshes.front(), start.mesh.n_points(), now_there);
    for (std::size_t f = 0; f < start.fields.size(); ++f) {
      DriftRow row = compare(start, masses, f, now_there.values[f]);
      row.kind = name_of(problem.kind);
      row.trips = count;
      drift.rows.push_back(std::move(row));
    }
  }
  drift.trip_seconds.push_back(elapsed / done);
  co_await graph.destroy();
  co_await destroy(meshes);
}

}  // namespace

std::vector<std::int32_t> parse_trips(const std::string& text) {
  std::vector<std::int32_t> trips;
  for (const std::string& word : split_at_commas(text)) {
    std::int32_t count = 0;
    if (!read_number(word, count) || count < 1 || count > 1000000 ||
        (!trips.empty() && count <= trips.back()))
      fail(ErrorCode::bad_argument, "--round-trips: '", text,
           "' is no list of ascending numbers from 1; give for example 1,2,5,10");
    trips.push_back(count);
  }
  return trips;
}

Task measure_drift(Request request, const std::vector<TransferKind>& kinds,
                   const std::vector<std::int32_t>& trips, apps::Progress& progress, Drift& drift) {
  request.pairs = "A:B,B:A";
  progress.phase("reading");
  Problem problem = load(request, machine());
  drift.source = request.source;
  drift.target = request.target;
  drift.machine = machine().describe();
  drift.policy = request.policy;
  for (const TransferKind kind : kinds) {
    problem.kind = kind;
    co_await run_kind(problem, trips, progress, drift);
  }
}

}  // namespace m2m_transfer
