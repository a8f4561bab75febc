// The activity of each PE over time, as SVG: one row per PE, bars by activity, a time axis below.
// Written without gnuplot. The bars are written beside it as CSV (row,begin,end,activity).
//
//     PE 0  ████░░███████▒▒████
//     PE 1  ██████████░░░▒▒████      busy █   idle ░   balancing ▒
//           0        5        10 ms
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace kit {

/// The colour class of a bar.
enum class Activity { busy, idle, balancing };

struct Bar {
  std::size_t row = 0;        ///< index into Timeline::rows
  double begin = 0, end = 0;  ///< seconds
  Activity activity = Activity::busy;
};

struct Timeline {
  std::string title{};
  std::vector<std::string> rows{};  ///< their names, from the top
  std::vector<Bar> bars{};          ///< in any order; time without a bar stays white
};

/// Throws tess::Error: for a bar that names no row, is not finite or ends before it begins
/// (bad_value, with its index); for a path that does not end in .svg or cannot be written.
void write_svg(const std::string& path, const Timeline& timeline);

}  // namespace kit
