#include "apps/lb_lab/output/report.hpp"

#include "apps/kit/json.hpp"
#include "apps/kit/write_file.hpp"
#include "apps/lb_lab/run/kind.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>

namespace lb_lab {
namespace {

constexpr const char* line =
    "{:<20} {:>6} {:<14} {:>10} {:>10} {:>7} {:>7} {:>7} {:>8} {:>10} {:>10} {:>7}\n";

std::string hash_text(std::uint64_t answer) {
  return fmt::format("{:016x}", answer);
}

/// Six digits: more are noise.
double rounded(double value) {
  return std::stod(fmt::format("{:.6g}", value));
}

kit::Json json_of(const Row& row) {
  return {{"workload", row.workload},
          {"strategy", row.strategy},
          {"per_pe", row.per_pe},
          {"pes", row.n_pes},
          {"iterations", row.n_iterations},
          {"seconds_total", row.seconds_total},
          {"seconds_per_iteration", row.seconds_total / row.n_iterations},
          {"imbalance_before", row.imbalance_before},
          {"imbalance_after", row.imbalance_after},
          {"moves", row.n_moves},
          {"bytes_moved", row.moved_bytes},
          {"balance_seconds", row.balance_seconds},
          {"gain", row.gain},
          {"result_hash", hash_text(row.answer)}};
}

}  // namespace

void print_head() {
  tess::print_text(fmt::format(fmt::runtime(line), "workload", "per_pe", "strategy", "seconds",
                               "ms/iter", "ideal", "before", "after", "moves", "KiB", "balance ms",
                               "gain"));
}

void print_row(const Row& row) {
  tess::print_text(fmt::format(
      fmt::runtime(line), row.workload, row.per_pe, row.strategy,
      fmt::format("{:.4f}", row.seconds_total),
      fmt::format("{:.3f}", 1e3 * row.seconds_total / row.n_iterations),
      fmt::format("{:.1f}%", 100 * row.ideal_seconds / row.seconds_total),
      fmt::format("{:.3f}", row.imbalance_before), fmt::format("{:.3f}", row.imbalance_after),
      row.n_moves, fmt::format("{:.0f}", static_cast<double>(row.moved_bytes) / 1024),
      fmt::format("{:.3f}", 1e3 * row.balance_seconds), fmt::format("{:.1f}%", 100 * row.gain)));
}

void print_best(const Sweep& sweep) {
  for (const std::string& workload : sweep.settings.workloads) {
    const Row& row = best_of(sweep, workload);
    tess::print_text(
        fmt::format("best of {}: {} chares per PE under {}, {:.4f} s, gain {:.1f} % over none\n",
                    workload, row.per_pe, row.strategy, row.seconds_total, 100 * row.gain));
  }
}

void write_json(const std::string& path, const Sweep& sweep) {
  const Settings& s = sweep.settings;
  kit::Json root = {
      {"machine", sweep.machine}, {"grain", s.grain},           {"period", s.period},
      {"when", s.when},           {"prediction", s.prediction}, {"seed", s.seed},
  };
  root["rows"] = kit::Json::array();
  root["ideal_seconds"] = kit::Json::array();
  root["imbalance_over_iterations"] = kit::Json::array();
  for (const Row& row : sweep.rows) {
    root["rows"].push_back(json_of(row));
    root["ideal_seconds"].push_back(row.ideal_seconds);
    kit::Json curve = kit::Json::array();
    for (const double value : row.imbalance_of_iteration) curve.push_back(rounded(value));
    root["imbalance_over_iterations"].push_back(std::move(curve));
  }
  root["best"] = kit::Json::array();
  for (const std::string& workload : s.workloads)
    root["best"].push_back(json_of(best_of(sweep, workload)));
  kit::write_file(path, kit::json_text(root, 1));
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
  out += "none: no balancer is made, no load measured, no barrier\n";
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
