// The study of PEs: the steps of a scene on simulated machines of more and more PEs, with a fixed
// time per message and per item of each part of a search, so that it repeats bit for bit. These
// times are predictions; where this computer has as many cores, the steps are measured as well.
//
// Strong scaling takes the scene as it is. Weak scaling takes scenes made by rule, whose number is
// that of one PE. Each PE owns objects that are near each other at the beginning.
#pragma once

#include "apps/collide_scene/options.hpp"
#include "apps/collide_scene/run/result.hpp"
#include "apps/kit/progress.hpp"
#include "apps/kit/rows.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace collide_scene {

struct PesRow {
  std::int32_t n_pes = 1;
  std::string balance;  ///< the strategy, or none
  std::size_t n_objects = 0;
  double predicted = 0;              ///< seconds per step, with balancing: the median, without the
                                     ///< first step, which makes the voxels
  double balancing = 0;              ///< seconds of it
  std::uint64_t n_moved = 0;         ///< voxels, by the balancer
  std::optional<double> measured{};  ///< as `predicted`, on real PEs
  double speed_up = 1;               ///< against the first row, by predictions, per object
  double efficiency = 1;             ///< the speed-up by the increase of PEs
  Answer answer{};                   ///< over all steps
  bool agrees = true;                ///< as other machines do for these objects
};

/// Throws tess::Error, before a run begins, for options that do not fit each other.
void check_ladder(const Options& options);

/// Calls `found` with each row as it comes.
[[nodiscard]] std::vector<PesRow> study_pes(const Options& options, kit::Progress& progress,
                                            const std::function<void(const PesRow&)>& found);

[[nodiscard]] const kit::Rows<PesRow>& pes_report();
/// Efficiency against PEs for weak scaling, otherwise the time of a step; a line per strategy.
[[nodiscard]] kit::Chart chart_of(const std::vector<PesRow>& rows, bool is_weak);

}  // namespace collide_scene
