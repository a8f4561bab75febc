#include "apps/kit/output/timeline.hpp"

#include "apps/kit/output/axis.hpp"
#include "apps/kit/output/canvas.hpp"
#include "apps/kit/output/quoting.hpp"
#include "apps/kit/output/ticks.hpp"
#include "apps/kit/output/write_file.hpp"
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
    {{"busy", colours[0]}, {"idle", "#dddddd"}, {"balancing", colours[4]}}};

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

  Canvas canvas({.width = width, .height = base + bottom});
  canvas.text({left, 20}, timeline.title);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const double at = left + 110.0 * static_cast<double>(i);
    canvas.circle({at + 5, 40}, 5, {.fill = looks[i].colour});
    canvas.text({at + 16, 44}, looks[i].name);
  }
  // Rows too thin for a name each are named now and then.
  const auto every = static_cast<std::size_t>(std::ceil(14 / pitch));
  for (std::size_t row = 0; row < n_rows; row += every)
    canvas.text({left - 6, top + pitch * (static_cast<double>(row) + 0.5) + 4}, timeline.rows[row],
                Anchor::end);
  for (const Bar& bar : timeline.bars)
    canvas.rect({x(bar.begin), top + pitch * static_cast<double>(bar.row)},
                x(bar.end) - x(bar.begin), pitch * 0.85, {.fill = look(bar.activity).colour});
  if (last > first) {
    const Unit unit = unit_of(span);
    const double step = tick_step(span);
    for (double tick = 0; tick <= span * (1 + 1e-9); tick += step) {
      const double at = x(first + tick);
      canvas.path(Path().move({at, base}).line({at, base + 5}), {.stroke = "black"});
      canvas.text({at, base + 18}, number_text(tick / unit.seconds), Anchor::middle);
    }
    canvas.text({width - right, base + 34}, unit.name, Anchor::end);
  }
  return canvas.svg();
}

}  // namespace

void write_svg(const std::string& path, const Timeline& timeline) {
  check(timeline);
  write_file(data_path(path), csv(timeline));
  write_file(path, svg(timeline));
}

}  // namespace kit
