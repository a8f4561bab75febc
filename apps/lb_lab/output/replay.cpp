#include "apps/lb_lab/output/replay.hpp"

#include "apps/kit/rows.hpp"
#include "runtime/balance/datafile/lb_datafile.hpp"
#include "runtime/balance/fold.hpp"
#include "runtime/balance/memory.hpp"
#include "runtime/balance/metrics.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <map>

namespace lb_lab {
namespace {

using tess::balance::Snapshot;

/// As the files have it, or on as many PEs and with such speeds and limits as the options say.
Snapshot prepared(const Settings& s, Snapshot snapshot) {
  const auto n_pes =
      s.replay_pes > 0 ? static_cast<std::size_t>(s.replay_pes) : snapshot.pes.size();
  snapshot = tess::balance::fold(std::move(snapshot), n_pes, tess::balance::parse_fold(s.fold));
  if (auto limits = limits_of_pes(s, n_pes); !limits.empty())
    snapshot.pes.memory_limit_bytes = std::move(limits);
  if (s.speeds.empty()) return snapshot;
  if (s.speeds.size() != n_pes)
    tess::fail(tess::ErrorCode::bad_argument, "--speed: ", s.speeds.size(),
               " speeds for a replay on ", n_pes, " PEs; give one per PE");
  snapshot.pes.speed = s.speeds;
  tess::balance::validate(snapshot);
  return snapshot;
}

/// What a strategy makes of a phase.
struct ReplayRow {
  std::uint64_t phase = 0;
  std::size_t n_pes = 0, n_elements = 0;
  std::string strategy;
  tess::balance::Metrics before, after;
  double seconds = 0;  ///< of the strategy
  std::uint64_t fullest = 0;
  std::size_t n_over = 0;  ///< PEs over their memory limit
};

constexpr kit::Column<ReplayRow> replay_columns[] = {
    {"phase", "phase", "6", kit::of<&ReplayRow::phase>},
    {"pes", "PEs", "6", kit::of<&ReplayRow::n_pes>},
    {"elements", "elements", "9", kit::of<&ReplayRow::n_elements>},
    {"strategy", "strategy", "<14", kit::of<&ReplayRow::strategy>},
    {"imbalance_before", "before", "8.3f",
     [](const ReplayRow& r) -> kit::Json { return r.before.max_over_average; }},
    {"imbalance_predicted", "predicted", "9.3f",
     [](const ReplayRow& r) -> kit::Json { return r.after.max_over_average; }},
    {"moves", "moves", "8", [](const ReplayRow& r) -> kit::Json { return r.after.n_moves; }},
    {"bytes_moved", "bytes", "12",
     [](const ReplayRow& r) -> kit::Json { return r.after.moved_bytes; }},
    {"external_bytes", "external bytes", "14",
     [](const ReplayRow& r) -> kit::Json { return r.after.external_bytes; }},
    {"strategy_seconds", "", nullptr, kit::of<&ReplayRow::seconds>},
    {"", "strategy ms", "12.3f", [](const ReplayRow& r) -> kit::Json { return 1e3 * r.seconds; }},
    {"fullest_pe_bytes", "fullest PE", "14", kit::of<&ReplayRow::fullest>},
    {"pes_over_limit", "over limit", "10", kit::of<&ReplayRow::n_over>}};

ReplayRow row_of(std::uint64_t phase, const Snapshot& snapshot, const std::string& name,
                 std::uint64_t seed) {
  const tess::balance::Strategy strategy = tess::balance::make_strategy(name, seed);
  const auto began = std::chrono::steady_clock::now();
  const tess::balance::Assignment wanted = strategy(snapshot);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  ReplayRow row{.phase = phase,
                .n_pes = snapshot.pes.size(),
                .n_elements = snapshot.elements.size(),
                .strategy = name,
                .before = measure(snapshot, snapshot.elements.pe),
                .after = measure(snapshot, wanted),
                .seconds = took.count()};
  const std::vector<std::uint64_t> memory = tess::balance::memory_of(snapshot, wanted);
  row.fullest = std::ranges::max(memory);
  for (std::size_t p = 0; p < memory.size(); ++p)
    if (const std::uint64_t limit = snapshot.pes.memory_limit_bytes[p];
        limit != 0 && memory[p] > limit)
      ++row.n_over;
  return row;
}

}  // namespace

std::vector<std::string> replay_files(const std::vector<std::string>& given) {
  std::vector<std::string> files;
  for (const std::string& path : given) {
    std::error_code none;
    if (!std::filesystem::is_directory(path, none)) {
      files.push_back(path);
      continue;
    }
    const std::size_t n_before = files.size();
    for (const auto& entry : std::filesystem::directory_iterator(path))
      if (const std::string name = entry.path().string();
          name.ends_with(".json") || name.ends_with(".json.br"))
        files.push_back(name);
    if (files.size() == n_before)
      tess::fail(tess::ErrorCode::bad_argument, "--replay: the folder ", path,
                 " has no file named *.json or *.json.br; give LBDatafiles, or their folder");
    std::sort(files.begin() + static_cast<std::ptrdiff_t>(n_before), files.end());
  }
  return files;
}

Replayed replay(const Settings& s) {
  // Before files are read.
  (void)tess::balance::parse_fold(s.fold);
  require_strategies(s);
  const bool all = std::ranges::count(s.strategies, "all") > 0;
  const std::vector<std::string>& names = all ? tess::balance::strategy_names() : s.strategies;
  Replayed out;
  std::vector<ReplayRow> rows;
  std::vector<tess::balance::Phase> phases =
      tess::balance::read_lb_datafiles(replay_files(s.replay));
  std::map<std::pair<std::string, std::string>, std::size_t> left_out;  // phases per name, reason
  for (tess::balance::Phase& phase : phases) {
    out.n_communications += phase.n_left_out;
    const Snapshot snapshot = prepared(s, std::move(phase.snapshot));
    for (const std::string& name : names) {
      const std::string why = tess::balance::obstacle(name, snapshot);
      if (why.empty()) {
        rows.push_back(row_of(phase.id, snapshot, name, s.seed));
      } else if (all) {
        ++left_out[{name, why}];
      } else {
        tess::fail(tess::ErrorCode::bad_argument, "--strategy ", name, ": ", why, " (phase ",
                   phase.id, " of ", s.replay.front(), s.replay.size() > 1 ? " and others" : "",
                   "); choose another, or all, which leaves it out");
      }
    }
  }
  const kit::Rows<ReplayRow> report(replay_columns);
  out.table = report.table(rows);
  out.rows = report.json(rows);
  out.left_out = kit::Json::array();
  for (const auto& [what, n_phases] : left_out) {
    const auto& [name, why] = what;
    out.table +=
        fmt::format("left out in {} of {} phases: {}: {}\n", n_phases, phases.size(), name, why);
    out.left_out.push_back({{"strategy", name}, {"phases", n_phases}, {"reason", why}});
  }
  if (out.n_communications > 0)
    out.table += fmt::format(
        "left out: {} communications that are not from one task of the files to another\n",
        out.n_communications);
  return out;
}

}  // namespace lb_lab
