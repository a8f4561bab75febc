// The options of the command line. Every room may include this header; it includes none of them.
#pragma once

#include "apps/kit/progress.hpp"
#include "runtime/balance_options.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace particles {

/// How a run is carried out; no result depends on it.
struct RunOptions {
  /// Blocks migrate: in rounds after each exchange of particles, or beside the work (see
  /// runtime/balance.hpp). Absent: they stay, and no load is measured.
  std::optional<tess::BalanceOptions> balance{};
  kit::Progress* progress = nullptr;  ///< shows the phase of the run; may be null
};

struct Options {
  std::string scene;
  std::optional<std::int32_t> steps;  ///< instead of the scene's
  std::string out;
  bool study = false;            ///< instead of a run
  std::vector<int> resolutions;  ///< of the study; empty: the usual ones
  bool compressed = false;       ///< also where the scene does not ask for it
  RunOptions run{};
};

}  // namespace particles
