#include "apps/kit/output/chart.hpp"

#include "apps/kit/output/axis.hpp"
#include "apps/kit/output/gnuplot.hpp"
#include "apps/kit/output/quoting.hpp"
#include "apps/kit/output/style.hpp"
#include "apps/kit/output/write_file.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <iterator>
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

/// How gnuplot draws series `i`: filled marks, then open ones, that can be told apart in print.
std::string with(const Series& series, std::size_t i) {
  constexpr std::array marks{7, 5, 9, 11, 13, 6, 4, 8, 10, 12};
  const std::string colour = fmt::format("linecolor rgb '{}'", colours[i % colours.size()]);
  const std::string mark = fmt::format("pointtype {} pointsize 0.8", marks[i % marks.size()]);
  const bool bars = has_bars(series);
  switch (series.style) {
    case Style::lines_points:
      return fmt::format("{} linewidth 2 {} {}", bars ? "yerrorlines" : "linespoints", colour,
                         mark);
    case Style::lines:  // no marks tell it from the line of the same colour
      return fmt::format("{} linewidth 2 {}{}", bars ? "yerrorlines pointsize 0" : "lines", colour,
                         i >= colours.size() ? " dashtype 4" : "");
    case Style::points:
      return fmt::format("{} {} {}", bars ? "yerrorbars" : "points", colour, mark);
    case Style::dashes:
      return "lines dashtype 2 linewidth 1.5 " + colour;
    case Style::published:
      return "points pointtype 12 pointsize 1.8 linewidth 2 linecolor rgb '#000000'";
  }
  return "";
}

/// The axis of a coordinate of all points that can be drawn.
Axis axis_along(const Chart& chart, double Point::*of, bool log, std::vector<double> ticks,
                bool from_zero) {
  std::vector<double> values;
  for (const Series& series : chart.series)
    for (const Point& p : series.points) {
      if (!can_be_drawn(chart, p)) continue;
      values.push_back(p.*of);
      if (of != &Point::y) continue;
      for (const double end : {p.low, p.high})
        if (std::isfinite(end) && (!log || end > 0)) values.push_back(end);
    }
  return axis_of(std::move(values), log, std::move(ticks), from_zero);
}

/// Ends and labels of an axis. (gnuplot rounds the ends of a logarithmic axis, and omits labels that
/// are then outside.)
std::string describe(const Axis& axis, char name) {
  std::string ticks;
  for (const auto& [at, label] : axis.ticks)
    fmt::format_to(Text(ticks), "{}'{}' {}", ticks.empty() ? "" : ",", label, at);
  const double margin = 1e-9 * (axis.log ? 1 : axis.high - axis.low);
  return fmt::format("set {0}range [{1}:{2}] noextend\nset {0}tics ({3})\n", name,
                     axis.log ? axis.low * (1 - margin) : axis.low - margin,
                     axis.log ? axis.high * (1 + margin) : axis.high + margin, ticks);
}

/// A corner of the plot in which no curve is, for the key; beside the plot if there is none.
std::string place_of_key(const Chart& chart, const Axis& x, const Axis& y) {
  constexpr double plot_width = 600, plot_height = 390;  // about, in pixels
  double width = 0, height = 20;
  for (const Series& series : chart.series) {
    if (series.name.empty() || series.points.empty()) continue;
    width = std::max(width, 60 + 0.6 * font_size * static_cast<double>(series.name.size()));
    height += 1.55 * font_size;
  }
  const double w = width / plot_width, h = height / plot_height;
  const auto is_free = [&](bool right, bool top) {
    const auto holds = [&](double u, double v) {
      return (right ? u > 1 - w : u < w) && (top ? v > 1 - h : v < h);
    };
    for (const Series& series : chart.series) {
      const Point* last = nullptr;
      for (const Point& p : series.points) {
        if (!can_be_drawn(chart, p)) {
          last = nullptr;
          continue;
        }
        const bool joined =
            last != nullptr && series.style != Style::points && series.style != Style::published;
        const Point from = joined ? *last : p;
        constexpr int parts = 32;
        for (int k = joined ? 0 : parts; k <= parts; ++k) {
          const auto on = [&](const Axis& axis, double a, double b) {
            return std::lerp(axis.part(a), axis.part(b), static_cast<double>(k) / parts);
          };
          if (holds(on(x, from.x, p.x), on(y, from.y, p.y))) return false;
        }
        last = &p;
      }
    }
    return true;
  };
  for (const bool top : {true, false})
    for (const bool right : {true, false})
      if (w < 0.6 && is_free(right, top))
        return fmt::format("inside {} {}", right ? "right" : "left", top ? "top" : "bottom");
  return "outside right top";
}

/// The points of each series as a block of data, then one plot command that names the blocks: no
/// file name and no text of ours stands where gnuplot would interpret it.
std::string script(const Chart& chart) {
  const Axis x = axis_along(chart, &Point::x, chart.x_log, chart.x_ticks, false);
  const Axis y = axis_along(chart, &Point::y, chart.y_log, {}, true);
  std::string out = fmt::format(
      "set encoding utf8\n"
      "set terminal svg noenhanced size 720,480 background rgb 'white' font 'sans-serif,{}'\n"
      "set grid linetype 1 linecolor rgb '#dddddd'\nset border 3\nset tics nomirror out\n"
      "set key {} Left reverse samplen 2\n",
      font_size, place_of_key(chart, x, y));
  Text to(out);
  fmt::format_to(to, "set title {}\n", gnuplot_string(chart.title));
  fmt::format_to(to, "set xlabel {}\n", gnuplot_string(chart.x_label));
  fmt::format_to(to, "set ylabel {}\n", gnuplot_string(chart.y_label));
  if (chart.x_log) out += "set logscale x\n";
  if (chart.y_log) out += "set logscale y\n";
  if (chart.equal_axes) out += "set size ratio -1\n";
  out += describe(x, 'x') + describe(y, 'y');
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
    fmt::format_to(to, "{}$data{} using 1:2{} ", std::exchange(comma, ", "), i,
                   has_bars(series) ? ":3:4" : "");
    if (series.name.empty())
      out += "notitle ";
    else
      fmt::format_to(to, "title {} ", gnuplot_string(series.name));
    out += "with " + with(series, i);
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
