#include "apps/lb_lab/output/report.hpp"

#include "apps/kit/limits.hpp"
#include "apps/kit/output/write_file.hpp"
#include "apps/lb_lab/run/kind.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/run.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>

namespace lb_lab {
namespace {

using R = const Row&;
using kit::Json;

constexpr kit::Column<Row> columns[] = {
    {"workload", "workload", "<20", kit::of<&Row::workload>},
    {"per_pe", "per_pe", "6", kit::of<&Row::per_pe>},
    {"strategy", "strategy", "<14", kit::of<&Row::strategy>},
    {"pes", "", nullptr, kit::of<&Row::n_pes>},
    {"iterations", "", nullptr, kit::of<&Row::n_iterations>},
    {"seconds_total", "seconds", "10.4f", kit::of<&Row::seconds_total>},
    {"seconds_per_iteration", "", nullptr,
     [](R r) -> Json { return r.seconds_total / r.n_iterations; }},
    {"", "ms/iter", "10.3f", [](R r) -> Json { return 1e3 * r.seconds_total / r.n_iterations; }},
    {"seconds_of_runs", "", nullptr, kit::of<&Row::seconds_of_runs>},
    {"", "spread %", "8.1f",
     [](R r) {
       if (r.seconds_of_runs.size() < 2) return Json();
       return Json(100 * (std::ranges::max(r.seconds_of_runs) / r.seconds_total - 1));
     }},
    {"ideal_seconds", "", nullptr, kit::of<&Row::ideal_seconds>},
    {"", "ideal %", "7.1f", [](R r) -> Json { return 100 * r.ideal_seconds / r.seconds_total; }},
    {"imbalance_before", "before", "7.3f", kit::of<&Row::imbalance_before>},
    {"imbalance_after", "after", "7.3f", kit::of<&Row::imbalance_after>},
    {"moves", "moves", "8", kit::of<&Row::n_moves>},
    {"bytes_moved", "", nullptr, kit::of<&Row::moved_bytes>},
    {"", "KiB", "10.0f", [](R r) -> Json { return static_cast<double>(r.moved_bytes) / 1024; }},
    {"balance_seconds", "", nullptr, kit::of<&Row::balance_seconds>},
    {"", "balance ms", "10.3f", [](R r) -> Json { return 1e3 * r.balance_seconds; }},
    {"", "messages %", "10.1f",
     [](R r) { return r.limits.runtime < 0 ? Json() : Json(100 * r.limits.runtime); }},
    {"gain", "", nullptr, kit::of<&Row::gain>},
    {"", "gain %", "7.1f", [](R r) -> Json { return 100 * r.gain; }},
    {"limits", "", nullptr, [](R r) -> Json { return kit::limits_json(r.limits); }},
    {"result_hash", "", nullptr, [](R r) -> Json { return kit::hex(r.answer); }},
    {"imbalance_of_iteration", "", nullptr, [](R r) {
       Json curve = Json::array();
       for (const double value : r.imbalance_of_iteration) curve.push_back(kit::rounded(value));
       return curve;
     }}};

}  // namespace

const kit::Rows<Row>& report() {
  static const kit::Rows<Row> rows(columns);
  return rows;
}

const Row& best_of(const Sweep& sweep, const std::string& workload) {
  const Row* best = nullptr;
  for (const Row& row : sweep.rows)
    if (row.workload == workload && (best == nullptr || row.seconds_total < best->seconds_total))
      best = &row;
  return *best;
}

std::string best_text(const Sweep& sweep) {
  std::string out;
  for (const std::string& workload : sweep.settings.workloads) {
    const Row& row = best_of(sweep, workload);
    out += fmt::format("best of {}: {} chares per PE under {}, {:.4f} s, gain {:.1f} % over none\n",
                       workload, row.per_pe, row.strategy, row.seconds_total, 100 * row.gain);
    for (const Row& other : sweep.rows)  // none, and the best itself
      if (other.workload == workload && other.per_pe == row.per_pe &&
          (other.strategy == "none" || other.strategy == row.strategy))
        out += fmt::format("  {}: {}\n", other.strategy, tess::describe(other.limits));
  }
  return out;
}

Json best_json(const Sweep& sweep) {
  std::vector<Row> best;
  for (const std::string& workload : sweep.settings.workloads)
    best.push_back(best_of(sweep, workload));
  return report().json(best);
}

std::string list_text() {
  std::string out = "workloads:\n", with_neighbours;
  for (const Workload& one : workloads())
    (one.name.ends_with("_comm") ? with_neighbours : out) +=
        fmt::format("  {:<20} {}\n", one.name, one.what);
  out += "the same, and each cell depends on its neighbours:\n" + with_neighbours;
  return out + fmt::format("strategies: {}\n", fmt::join(tess::balance::strategy_names(), ", "));
}

std::string explain_text(const Settings& s, std::int32_t n_pes) {
  std::string out;
  for (const std::string& name : s.workloads) {
    const Problem p = problem_of(s, find_workload(name), n_pes);
    const double total = total_seconds(p);
    const Kind& kind = *workload_of(p).kind;
    double speed = n_pes;
    if (!s.speeds.empty()) {
      speed = std::reduce(s.speeds.begin(), s.speeds.end());
      if (kind.speeds == Speeds::relative) speed /= std::ranges::max(s.speeds);
    }
    out += fmt::format("{}: {}; {:.4g} s of work, {:.4g} s at best on {} PEs\n", name,
                       kind.describe(p), total, total / speed, n_pes);
  }
  out += fmt::format("{} runs of {} iterations",
                     s.workloads.size() * s.per_pe.size() * s.strategies.size() *
                         static_cast<std::size_t>(s.repeat),
                     s.n_iterations);
  out +=
      s.when == "periodic"
          ? fmt::format(", a round about every {} iterations beside the work, no barrier\n",
                        s.period)
          : fmt::format(", a barrier every {} iterations{}\n", s.period,
                        s.when == "automatic" ? ", a round where it gains more than it costs" : "");
  out += "none: no balancer is made, no barrier; loads are measured for its limits only\n";
  if (s.plot.empty()) out += "left out: intervals for timelines (--plot)\n";
  if (s.snapshots.empty()) out += "left out: snapshots for strategies (--save-snapshot)\n";
  return out;
}

namespace {

/// A replay takes all files of a folder: those of a run before, on more PEs or in another format,
/// go.
void remove_snapshots(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (std::string name = entry.path().filename().string();
        name.starts_with("data.") && (name.ends_with(".json") || name.ends_with(".json.br")))
      old.push_back(entry.path());
  for (const std::filesystem::path& path : old) std::filesystem::remove(path);
}

}  // namespace

void save_snapshots(const Settings& s, const Row& row, const Outcome& outcome) {
  const std::filesystem::path folder =
      std::filesystem::path(s.snapshots) /
      fmt::format("{}-{}-{}", row.workload, row.per_pe, row.strategy);
  std::error_code error;
  if (outcome.phases.empty()) {  // those of a run before are not of this one
    if (std::filesystem::is_directory(folder, error)) remove_snapshots(folder);
    return;
  }
  std::filesystem::create_directories(folder, error);
  if (error)
    tess::fail(tess::ErrorCode::environment, "--save-snapshot: ", folder.string(), ": ",
               error.message());
  remove_snapshots(folder);
  for (std::int32_t pe = 0; pe < row.n_pes; ++pe) {
    const std::string file = (folder / fmt::format("data.{}.{}", pe, s.snapshot_format)).string();
    const std::string text = tess::balance::write_lb_datafile(outcome.phases, tess::PeId{pe});
    kit::write_file(file, tess::balance::lb_datafile_bytes(file, text));
  }
}

}  // namespace lb_lab
