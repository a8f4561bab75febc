#include "apps/lb_lab/output/replay.hpp"

#include "apps/kit/limits.hpp"
#include "apps/kit/rows.hpp"
#include "runtime/balance/datafile/lb_datafile.hpp"
#include "runtime/balance/fold.hpp"
#include "runtime/balance/memory.hpp"
#include "runtime/balance/metrics.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <tuple>

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
  std::size_t n_over = 0;        ///< PEs over their memory limit
  std::uint64_t sent_bytes = 0;  ///< of all edges
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
    {"pes_over_limit", "over limit", "10", kit::of<&ReplayRow::n_over>},
    {"", "external %", "10.1f", [](const ReplayRow& r) {
       return r.sent_bytes == 0 ? kit::Json()
                                : kit::Json(100 * static_cast<double>(r.after.external_bytes) /
                                            static_cast<double>(r.sent_bytes));
     }}};

ReplayRow row_of(std::uint64_t phase, const Snapshot& snapshot, const std::string& name,
                 std::uint64_t seed, tess::balance::Assignment& wanted) {
  const tess::balance::Strategy strategy = tess::balance::make_strategy(name, seed);
  const auto began = std::chrono::steady_clock::now();
  wanted = strategy(snapshot);
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
  for (const tess::balance::Edge& edge : snapshot.edges) row.sent_bytes += edge.bytes;
  return row;
}

/// The means over the phases that a strategy served.
struct OfStrategy {
  std::string name;
  double n_phases = 0, before = 0, predicted = 0, moves = 0, seconds = 0;
};

/// Of all strategies; the first is the one that served most phases, with the least imbalance, then
/// the fewest moves.
std::vector<OfStrategy> best_first(const std::vector<ReplayRow>& rows) {
  std::vector<OfStrategy> all;
  for (const ReplayRow& row : rows) {
    auto at = std::ranges::find(all, row.strategy, &OfStrategy::name);
    if (at == all.end()) at = all.insert(at, {row.strategy});
    const double weight = 1 / ++at->n_phases;
    at->before += weight * (row.before.max_over_average - at->before);
    at->predicted += weight * (row.after.max_over_average - at->predicted);
    at->moves += weight * (static_cast<double>(row.after.n_moves) - at->moves);
    at->seconds += weight * (row.seconds - at->seconds);
  }
  std::ranges::stable_sort(all, {}, [](const OfStrategy& one) {
    return std::tuple(-one.n_phases, std::round(1000 * one.predicted), one.moves);
  });
  return all;
}

constexpr kit::Column<OfStrategy> strategy_columns[] = {
    {"strategy", "", nullptr, kit::of<&OfStrategy::name>},
    {"phases", "", nullptr, kit::of<&OfStrategy::n_phases>},
    {"imbalance_before", "", nullptr, kit::of<&OfStrategy::before>},
    {"imbalance_predicted", "", nullptr, kit::of<&OfStrategy::predicted>},
    {"moves", "", nullptr, kit::of<&OfStrategy::moves>},
    {"strategy_seconds", "", nullptr, kit::of<&OfStrategy::seconds>}};

constexpr std::size_t most_shown = 16, most_written = 256;  // PEs of a communication matrix

/// What limits a phase under a strategy, and the communication matrix.
void add_phase(Replayed& out, std::uint64_t phase, const Snapshot& snapshot,
               const std::string& strategy, const tess::balance::Assignment& assignment) {
  const tess::LoadSummary limits =
      tess::summarise(tess::balance::loads_of_pes(snapshot, assignment));
  kit::Json json{{"phase", phase}, {"strategy", strategy}, {"limits", kit::limits_json(limits)}};
  out.summary += fmt::format("phase {} under {}: {}\n", phase, strategy, tess::describe(limits));
  const std::size_t n = snapshot.pes.size();
  if (n <= most_written && !snapshot.edges.empty()) {
    const auto bytes = tess::balance::bytes_between(snapshot, assignment);
    json["bytes_between_pes"] = bytes;
    if (n <= most_shown) out.summary += "  bytes from each PE (row) to each (column):\n";
    for (std::size_t p = 0; n <= most_shown && p < n; ++p)
      out.summary += fmt::format("  {:>12}\n", fmt::join(bytes[p], " "));
  }
  out.last_phase.push_back(std::move(json));
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

Replayed replay(const Settings& s, kit::Progress* progress) {
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
  out.last_phase = kit::Json::array();
  if (progress != nullptr) progress->phase("replaying");
  std::size_t n_done = 0;
  for (tess::balance::Phase& phase : phases) {
    out.n_communications += phase.n_left_out;
    const Snapshot snapshot = prepared(s, std::move(phase.snapshot));
    for (const std::string& name : names) {
      const std::string why = tess::balance::obstacle(name, snapshot);
      if (why.empty()) {
        if (progress != nullptr) progress->part(n_done + 1, names.size() * phases.size());
        tess::balance::Assignment wanted;
        rows.push_back(row_of(phase.id, snapshot, name, s.seed, wanted));
        if (&phase == &phases.back()) add_phase(out, phase.id, snapshot, name, wanted);
      } else if (all) {
        ++left_out[{name, why}];
      } else {
        tess::fail(tess::ErrorCode::bad_argument, "--strategy ", name, ": ", why, " (phase ",
                   phase.id, " of ", s.replay.front(), s.replay.size() > 1 ? " and others" : "",
                   "); choose another, or all, which leaves it out");
      }
      ++n_done;
    }
  }
  const kit::Rows<ReplayRow> report(replay_columns);
  out.table = report.table(rows);
  out.rows = report.json(rows);
  const std::vector<OfStrategy> strategies = best_first(rows);
  out.strategies = kit::Rows<OfStrategy>(strategy_columns).json(strategies);
  if (!strategies.empty()) {
    const OfStrategy& best = strategies.front();
    out.summary += fmt::format(
        "best of {} strategies: {}, max/average {:.3f} -> {:.3f}, {:.1f} moves and {:.3f} ms per "
        "phase (means of {} phases)\n",
        strategies.size(), best.name, best.before, best.predicted, best.moves, 1e3 * best.seconds,
        best.n_phases);
  }
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
