// The settings of the command line, in the form that users of Task Bench write: -steps 100 -width 8
// -type fft -and -type tree. They are checked before anything runs.
#pragma once

#include "apps/task_bench/graph.hpp"
#include "runtime/balance.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace task_bench {

struct Settings {
  std::vector<Graph> graphs;  ///< run at once; with `all_types`: one, of each type in turn
  bool all_types = false;
  bool metg = false;
  std::int32_t repeat = 0;  ///< runs of each grain; the median counts
  bool fastest = false;     ///< or the fastest
  std::int64_t sync_every = 10;
  std::optional<tess::BalanceOptions> balance;
  std::optional<std::pair<std::int64_t, std::int64_t>> spoiled;  ///< step and point of a task
  std::string json, csv, plot;
  bool explain = false;
};

/// The settings; none if the first process printed --help. Throws tess::Error for settings that
/// cannot run on this machine.
[[nodiscard]] std::optional<Settings> parse(int argc, char** argv, const tess::Machine& machine);

/// The sets of graphs to run, one after the other: with -type all one per type. Throws tess::Error
/// if the options of one are inconsistent.
[[nodiscard]] std::vector<std::vector<Graph>> cases(const Settings& settings);

}  // namespace task_bench
