// Line charts as SVG, for the reports of programs: error against run time, time against chares
// per PE. The data is written beside the picture as CSV (series,x,y, and low,high of error bars;
// NAME.csv for NAME.svg), so that no data is lost without gnuplot. The key is where no curve is.
//
//     kit::Chart chart{.title = "transfer", .x_label = "seconds", .y_label = "L2", .x_log = true};
//     chart.series.push_back({"kuhn", {{0.1, 1e-2}, {0.8, 2.5e-3}}});
//     kit::write_svg("study/error_time.svg", chart);
#pragma once

#include <string>
#include <vector>

namespace kit {

struct Point {
  double x = 0, y = 0;
  double low = y, high = y;  ///< the ends of its error bar
};

/// `published`: what others have measured, as points that are larger than ours.
enum class Style { lines_points, lines, points, dashes, published };

struct Series {
  std::string name{};  ///< any text; empty: not in the key
  std::vector<Point> points{};
  Style style = Style::lines_points;
};

struct Chart {
  std::string title{}, x_label{}, y_label{};  ///< any text
  bool x_log = false, y_log = false;
  std::vector<double> x_ticks{};  ///< where the x axis is labelled; empty: chosen (axis.hpp)
  bool equal_axes = false;        ///< one unit is as long in x as in y: for paths in space
  std::vector<Series> series{};
};

/// Writes the data as CSV and draws it through gnuplot. True if the picture is there; false, with
/// one line on standard error, where gnuplot is missing or no point can be drawn. A point that is
/// not finite, or not positive on a logarithmic axis, interrupts its line and stands in the CSV
/// only; one line on standard error counts them. Throws tess::Error that names the path: it does
/// not end in .svg, cannot be written, or gnuplot failed.
bool write_svg(const std::string& path, const Chart& chart);

}  // namespace kit
