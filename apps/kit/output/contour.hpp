// Contour lines of values on a grid, by marching squares with linear interpolation.
//
//     o───o───o    o: at or above the level; •: below. Each crossing of a grid edge belongs to the
//     │ ╭─┼─╮ │    two squares beside that edge, so that lines close by themselves. Everything
//     o─┼─•─┼─o    beyond the border is above: lines that reach the border follow it.
//     │ ╰─┼─╯ │
//     o───o───o
#pragma once

#include "apps/kit/output/chart.hpp"

#include <functional>
#include <vector>

namespace kit {

/// The closed lines around the region where values are below `level`, in units of the grid: sample
/// (i, j) is at x = i, y = j. They run counter-clockwise around the region, clockwise around its
/// holes: a fill by winding number fills the region. A value that is not a number counts as above.
[[nodiscard]] std::vector<std::vector<Point>> contours(
    int n_columns, int n_rows, const std::function<double(int column, int row)>& value,
    double level);

}  // namespace kit
