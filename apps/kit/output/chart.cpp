#include "apps/kit/output/chart.hpp"

#include "apps/kit/output/gnuplot.hpp"
#include "apps/kit/output/quoting.hpp"
#include "apps/kit/output/write_file.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

namespace kit {
namespace {

using Text = std::back_insert_iterator<std::string>;

bool can_be_drawn(const Chart& chart, const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && (!chart.x_log || p.x > 0) &&
         (!chart.y_log || p.y > 0);
}

bool has_bars(const Series& series) {
  return std::ranges::any_of(series.points, [](const Point& p) { return p.low < p.high; });
}

std::string csv(const Chart& chart) {
  const bool bars = std::ranges::any_of(chart.series, &has_bars);
  std::string out = bars ? "series,x,y,low,high\n" : "series,x,y\n";
  for (const Series& series : chart.series) {
    const std::string name = csv_field(series.name);
    for (const Point& p : series.points) {
      fmt::format_to(Text(out), "{},{},{}", name, p.x, p.y);
      if (bars) fmt::format_to(Text(out), ",{},{}", p.low, p.high);
      out += '\n';
    }
  }
  return out;
}

std::string_view with(Style style) {
  switch (style) {
    case Style::lines_points:
      return "linespoints linewidth 2";
    case Style::lines:
      return "lines linewidth 2";
    case Style::points:
      return "points";
    case Style::dashes:
      return "lines dashtype 2 linewidth 1";
  }
  return "";
}

/// Distinct also for colour-blind readers (Okabe and Ito 2008); marks differ, too.
constexpr std::array colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                             "#e69f00", "#56b4e9", "#000000", "#999999"};

/// Places of labels, each with its text: whole numbers have all their digits.
std::string ticks(const Chart& chart) {
  std::string out;
  for (const double at : chart.x_ticks) {
    const bool is_whole = at == std::round(at);
    fmt::format_to(Text(out), "{}'{}' {}", out.empty() ? "" : ",",
                   is_whole ? fmt::format("{}", at) : fmt::format("{:.3g}", at), at);
  }
  return out;
}

/// The axis ends with the data, not at a round number without a label. On a logarithmic axis
/// gnuplot's ends are rounded, and may be inside the outermost labels, which it then omits.
std::string x_range(const Chart& chart) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const Series& series : chart.series) {
    for (const Point& p : series.points) {
      if (!can_be_drawn(chart, p)) continue;
      low = std::min(low, p.x);
      high = std::max(high, p.x);
    }
  }
  if (!chart.x_log || !(low < high)) return "set xrange [*:*] noextend\n";
  return fmt::format("set xrange [{}:{}] noextend\n", low * (1 - 1e-9), high * (1 + 1e-9));
}

/// The points of each series as a block of data, then one plot command that names the blocks: no
/// file name and no text of ours stands where gnuplot would interpret it.
std::string script(const Chart& chart) {
  std::string out =
      "set encoding utf8\n"
      "set terminal svg noenhanced size 720,480 background rgb 'white' font 'sans-serif,13'\n"
      "set grid linetype 1 linecolor rgb '#dddddd'\nset border 3\nset tics nomirror\n"
      "set key outside right top Left reverse samplen 2\nset format '%.6g'\n";
  Text to(out);
  fmt::format_to(to, "set title {}\n", gnuplot_string(chart.title));
  fmt::format_to(to, "set xlabel {}\n", gnuplot_string(chart.x_label));
  fmt::format_to(to, "set ylabel {}\n", gnuplot_string(chart.y_label));
  if (chart.x_log) out += "set logscale x\n";
  if (chart.y_log) out += "set logscale y\n";
  if (chart.equal_axes) out += "set size ratio -1\n";
  if (!chart.x_ticks.empty()) {
    fmt::format_to(to, "set xtics ({})\n", ticks(chart));
    out += x_range(chart);
  }
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    fmt::format_to(to, "$data{} << END\n", i);
    for (const Point& p : chart.series[i].points) {
      if (can_be_drawn(chart, p))
        fmt::format_to(to, "{} {} {} {}\n", p.x, p.y, p.low, p.high);
      else
        out += "NaN NaN NaN NaN\n";
    }
    out += "END\n";
  }
  out += "plot ";
  std::string_view comma;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const Series& series = chart.series[i];
    if (series.points.empty()) continue;
    fmt::format_to(to, "{}$data{} using 1:2 ", std::exchange(comma, ", "), i);
    if (series.name.empty())
      out += "notitle ";
    else
      fmt::format_to(to, "title {} ", gnuplot_string(series.name));
    fmt::format_to(to, "with {} linecolor rgb '{}'", with(series.style),
                   colours[i % colours.size()]);
    if (series.style == Style::lines_points || series.style == Style::points)
      fmt::format_to(to, " pointtype {} pointsize 0.7", 1 + i % 13);
    if (series.style == Style::lines && i >= colours.size())
      out += " dashtype 4";  // no marks tell it from the line of the same colour
    if (has_bars(series))
      fmt::format_to(
          to, ", $data{} using 1:2:3:4 notitle with yerrorbars linecolor rgb '{}' pointsize 0", i,
          colours[i % colours.size()]);
  }
  out += '\n';
  return out;
}

}  // namespace

bool write_svg(const std::string& path, const Chart& chart) {
  const std::string data = data_path(path);
  write_file(data, csv(chart));
  std::size_t drawn = 0, left_out = 0;
  for (const Series& series : chart.series)
    for (const Point& p : series.points) ++(can_be_drawn(chart, p) ? drawn : left_out);
  if (drawn == 0) {
    fmt::print(stderr, "plot: {}: not drawn, no point of {} can be\n", path, data);
    return false;
  }
  if (left_out != 0)
    fmt::print(stderr,
               "plot: {}: {} points of {} are not drawn (not finite, or not positive on a "
               "logarithmic axis)\n",
               path, left_out, data);
  const Drawing drawing = draw_with_gnuplot(script(chart));
  if (drawing.missing) {
    fmt::print(
        stderr,
        "plot: {}: not drawn, gnuplot is not installed (package gnuplot-nox); the data is in "
        "{}\n",
        path, data);
    return false;
  }
  if (!drawing.error.empty())
    tess::fail(tess::ErrorCode::environment, path, ": gnuplot could not draw it (", drawing.error,
               "); the data is in ", data);
  write_file(path, drawing.svg);
  return true;
}

}  // namespace kit
