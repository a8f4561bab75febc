#include "apps/kit/rows.hpp"

#include "apps/kit/output/fit.hpp"
#include "apps/kit/output/quoting.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <utility>

namespace kit {
namespace {

/// A format "[<]width[.digits and type]" in its parts.
struct Format {
  bool left = false;
  std::size_t width = 0;
  std::string rest{};  ///< ".4f"
};

Format format_of(const Heading& heading) {
  Format out;
  const char* at = heading.format;
  if (*at == '<') out.left = true, ++at;
  for (; *at >= '0' && *at <= '9'; ++at)
    out.width = 10 * out.width + static_cast<std::size_t>(*at - '0');
  out.rest = at;
  return out;
}

bool is_shown(const Heading& heading) {
  return heading.format != nullptr;
}
bool is_written(const Heading& heading) {
  return heading.name[0] != '\0';
}

std::string shown(const Json& value, const Format& format) {
  switch (value.kind()) {
    case Json::Kind::null:
      return "-";
    case Json::Kind::real:
      return format.rest.empty()
                 ? fmt::format("{:.6g}", value.real())
                 : fmt::format(fmt::runtime("{:" + format.rest + "}"), value.real());
    case Json::Kind::literal:
      return value.text() == "true" ? "yes" : value.text() == "false" ? "no" : value.text();
    case Json::Kind::string:
      return value.text();
    case Json::Kind::array:
    case Json::Kind::object:
      break;
  }
  std::string text = json_text(value, -1);
  text.pop_back();  // its line end
  return text;
}

/// One line of cells with these widths, without blanks at its end.
std::string line_of(std::span<const std::string> words, std::span<const Format> formats) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += ' ';
    out += formats[i].left ? fmt::format("{:<{}}", words[i], formats[i].width)
                           : fmt::format("{:>{}}", words[i], formats[i].width);
  }
  out.erase(out.find_last_not_of(' ') + 1);
  return out + '\n';
}

/// The columns of the table, none narrower than its title.
std::vector<Format> formats_of(std::span<const Heading> headings) {
  std::vector<Format> out;
  for (const Heading& heading : headings) {
    if (!is_shown(heading)) continue;
    out.push_back(format_of(heading));
    out.back().width = std::max(out.back().width, std::strlen(heading.title));
  }
  return out;
}

std::vector<std::string> titles_of(std::span<const Heading> headings) {
  std::vector<std::string> out;
  for (const Heading& heading : headings)
    if (is_shown(heading)) out.emplace_back(heading.title);
  return out;
}

std::vector<std::string> words_of(std::span<const Heading> headings, const Json& cells,
                                  std::span<const Format> formats) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < headings.size(); ++i)
    if (is_shown(headings[i])) out.push_back(shown(cells.members()[i].value, formats[out.size()]));
  return out;
}

/// Not finite or no number: NaN.
double number(const Json& value) {
  if (value.kind() == Json::Kind::real) return value.real();
  return value.kind() == Json::Kind::literal ? std::strtod(value.text().c_str(), nullptr) : NAN;
}

std::string csv_cell(const Json& value) {
  switch (value.kind()) {
    case Json::Kind::null:
      return "";
    case Json::Kind::real:
      return std::isfinite(value.real()) ? fmt::format("{}", value.real()) : "";
    default:
      return csv_field(shown(value, {}));
  }
}

}  // namespace

std::string hex(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

Json rounded(double value) {
  return std::isfinite(value) ? Json(std::stod(fmt::format("{:.6g}", value))) : Json();
}

std::string head_line(std::span<const Heading> headings) {
  return line_of(titles_of(headings), formats_of(headings));
}

std::string table_line(std::span<const Heading> headings, const Json& cells) {
  const std::vector<Format> formats = formats_of(headings);
  return line_of(words_of(headings, cells, formats), formats);
}

std::string table_text(std::span<const Heading> headings, const Json& cells) {
  std::vector<Format> formats = formats_of(headings);
  std::vector<std::vector<std::string>> lines{titles_of(headings)};
  for (const Json::Member& row : cells.members())
    lines.push_back(words_of(headings, row.value, formats));
  for (const std::vector<std::string>& words : lines)
    for (std::size_t i = 0; i < words.size(); ++i)
      formats[i].width = std::max(formats[i].width, words[i].size());
  std::string out;
  for (const std::vector<std::string>& words : lines) out += line_of(words, formats);
  return out;
}

std::string csv_text(std::span<const Heading> headings, const Json& cells) {
  std::string out;
  const auto append = [&](const auto& text_of) {
    const char* separator = "";
    for (std::size_t i = 0; i < headings.size(); ++i)
      if (is_written(headings[i])) out.append(std::exchange(separator, ",")).append(text_of(i));
    out += '\n';
  };
  append([&](std::size_t i) { return std::string(headings[i].name); });
  for (const Json::Member& row : cells.members())
    append([&](std::size_t i) { return csv_cell(row.value.members()[i].value); });
  return out;
}

Json json_rows(std::span<const Heading> headings, const Json& cells) {
  Json out = Json::array();
  for (const Json::Member& row : cells.members()) {
    Json one;
    for (std::size_t i = 0; i < headings.size(); ++i)
      if (is_written(headings[i])) one[headings[i].name] = row.value.members()[i].value;
    out.push_back(std::move(one));
  }
  return out;
}

Point* add_point(Chart& chart, const std::string& series, const Json& x, const Json& y) {
  const Point point{number(x), number(y)};
  if (std::isnan(point.x) || std::isnan(point.y)) return nullptr;
  const auto same = std::ranges::find(chart.series, series, &Series::name);
  Series& found = same != chart.series.end() ? *same : chart.series.emplace_back(Series{series});
  return &found.points.emplace_back(point);
}

std::optional<double> fitted_order(const Json& x, const Json& y) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < x.members().size(); ++i)
    points.push_back({number(x.members()[i].value), number(y.members()[i].value)});
  return fitted_power(points);
}

std::optional<double> order_between(Point a, Point b) {
  return fitted_power({a, b});
}

}  // namespace kit
