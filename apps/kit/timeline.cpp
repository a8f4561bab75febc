#include "apps/kit/timeline.hpp"

#include "apps/kit/quoting.hpp"
#include "apps/kit/ticks.hpp"
#include "apps/kit/write_file.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace kit {
namespace {

using Text = std::back_insert_iterator<std::string>;

struct Look {
  const char* name;
  const char* colour;
};
constexpr std::array<Look, 3> looks{
    {{"busy", "#0072b2"}, {"idle", "#dddddd"}, {"balancing", "#d55e00"}}};

const Look& look(Activity activity) {
  return looks[static_cast<std::size_t>(activity)];
}

// Pixels.
constexpr double width = 900, left = 90, right = 20, top = 60, bottom = 40;

/// Seconds, milliseconds or microseconds: whichever makes the numbers on the axis short.
struct Unit {
  const char* name;
  double seconds;
};
Unit unit_of(double span) {
  if (span >= 1) return {"s", 1};
  if (span >= 1e-3) return {"ms", 1e-3};
  return {"us", 1e-6};
}

void check(const Timeline& timeline) {
  for (std::size_t i = 0; i < timeline.bars.size(); ++i) {
    const Bar& bar = timeline.bars[i];
    const bool finite = std::isfinite(bar.begin) && std::isfinite(bar.end);
    if (bar.row >= timeline.rows.size() || !finite || bar.end < bar.begin)
      tess::fail(tess::ErrorCode::bad_value, "bar ", i, " of the timeline: row ", bar.row, " of ",
                 timeline.rows.size(), " from ", bar.begin, " to ", bar.end,
                 ": rows count from 0, times are finite and in order");
  }
}

std::string csv(const Timeline& timeline) {
  std::string out = "row,begin,end,activity\n";
  for (const Bar& bar : timeline.bars)
    fmt::format_to(Text(out), "{},{},{},{}\n", csv_field(timeline.rows[bar.row]), bar.begin,
                   bar.end, look(bar.activity).name);
  return out;
}

std::string svg(const Timeline& timeline) {
  const std::size_t n_rows = timeline.rows.size();
  const double pitch = n_rows <= 32 ? 20 : std::max(3.0, 640.0 / static_cast<double>(n_rows));
  const double base = top + pitch * static_cast<double>(n_rows);
  double first = 0, last = 0;
  for (std::size_t i = 0; i < timeline.bars.size(); ++i) {
    first = i == 0 ? timeline.bars[i].begin : std::min(first, timeline.bars[i].begin);
    last = i == 0 ? timeline.bars[i].end : std::max(last, timeline.bars[i].end);
  }
  const double span = last > first ? last - first : 1;
  const auto x = [&](double time) { return left + (time - first) / span * (width - left - right); };

  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\">\n<style>",
      width, base + bottom);
  Text to(out);
  for (const Look& each : looks) fmt::format_to(to, ".{}{{fill:{}}}", each.name, each.colour);
  fmt::format_to(to, "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n");
  fmt::format_to(to, "<text x=\"{}\" y=\"20\" font-size=\"14\">{}</text>\n", left,
                 xml_text(timeline.title));
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const double at = left + 110.0 * static_cast<double>(i);
    fmt::format_to(to, "<circle class=\"{}\" cx=\"{}\" cy=\"40\" r=\"5\"/>", looks[i].name, at + 5);
    fmt::format_to(to, "<text x=\"{}\" y=\"44\">{}</text>\n", at + 16, looks[i].name);
  }
  // Rows too thin for a name each are named now and then.
  const auto every = static_cast<std::size_t>(std::ceil(14 / pitch));
  for (std::size_t row = 0; row < n_rows; row += every)
    fmt::format_to(to, "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", left - 6,
                   top + pitch * (static_cast<double>(row) + 0.5) + 4,
                   xml_text(timeline.rows[row]));
  for (const Bar& bar : timeline.bars)
    fmt::format_to(to,
                   "<rect class=\"{}\" x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" "
                   "height=\"{:.1f}\"/>\n",
                   look(bar.activity).name, x(bar.begin),
                   top + pitch * static_cast<double>(bar.row), x(bar.end) - x(bar.begin),
                   pitch * 0.85);
  if (last > first) {
    const Unit unit = unit_of(span);
    const double step = tick_step(span);
    for (double tick = 0; tick <= span * (1 + 1e-9); tick += step) {
      fmt::format_to(to,
                     "<path d=\"M{0:.2f} {1}v5\" stroke=\"black\"/><text x=\"{0:.2f}\" y=\"{2}\" "
                     "text-anchor=\"middle\">{3:.6g}</text>\n",
                     x(first + tick), base, base + 18, tick / unit.seconds);
    }
    fmt::format_to(to, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", width - right,
                   base + 34, unit.name);
  }
  out += "</svg>\n";
  return out;
}

}  // namespace

void write_svg(const std::string& path, const Timeline& timeline) {
  check(timeline);
  write_file(data_path(path), csv(timeline));
  write_file(path, svg(timeline));
}

}  // namespace kit
