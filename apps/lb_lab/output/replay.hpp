// Strategies on snapshots from files: the moves of each, on any number of PEs, without a run.
#pragma once

#include "apps/kit/output/json.hpp"
#include "apps/kit/progress.hpp"
#include "apps/lb_lab/run/settings.hpp"

#include <string>
#include <vector>

namespace lb_lab {

/// The rows of a replay and what was left out, as a table and for the JSON.
struct Replayed {
  std::string table;
  std::string summary;  ///< the best strategy; limits of the last phase, bytes between its PEs
  kit::Json rows, left_out, strategies, last_phase;
  std::size_t n_communications = 0;  ///< left out, since they are not from a task to another
};

/// The files of --replay: as given, and of a folder all of its LBDatafiles, in the order of their
/// names. Throws tess::Error for a folder without any.
[[nodiscard]] std::vector<std::string> replay_files(const std::vector<std::string>& given);

/// Reads the files of one run and gives each phase to each strategy: predicted imbalance, moves,
/// bytes, time and memory. `all` leaves out, and says so at the end, the strategies
/// that cannot serve a phase. Throws tess::Error for files and options that cannot be used, and for
/// a strategy given by its name that cannot serve a phase.
[[nodiscard]] Replayed replay(const Settings& settings, kit::Progress* progress = nullptr);

}  // namespace lb_lab
