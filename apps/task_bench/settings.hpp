// The settings of the command line, in the form that users of Task Bench write: -steps 100 -width 8
// -type fft -and -type tree. They are checked before anything runs.
#pragma once

#include "apps/kit/driver.hpp"
#include "apps/task_bench/graph.hpp"
#include "runtime/balance.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace task_bench {

struct Settings {
  std::vector<Graph> graphs;  ///< run at once; with `all_types`: one, of each type in turn
  kit::Json words;            ///< the options of each graph as they are given
  bool all_types = false;
  bool metg = false;
  std::int32_t repeat = 0;  ///< runs of each grain; the median counts
  bool fastest = false;     ///< or the fastest
  std::int32_t sync_every = 10;
  std::string strategy, library;
  std::optional<tess::BalanceOptions> balance;
  std::vector<std::int32_t> spoiled;  ///< step and point of a task; or empty
  std::string csv;
};

/// Reads the options of graphs itself, the others by the driver. False if it printed the help: the
/// program is done. Throws tess::Error for settings that cannot run on so many PEs.
[[nodiscard]] bool parse(int argc, char** argv, std::int32_t n_pes, kit::Driver& driver,
                         Settings& settings);

/// The sets of graphs to run, one after the other: with -type all one per type. Throws tess::Error
/// if the options of one are inconsistent.
[[nodiscard]] std::vector<std::vector<Graph>> cases(const Settings& settings);

}  // namespace task_bench
