#include "apps/kit/output/canvas.hpp"

#include "apps/kit/output/quoting.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace kit {
namespace {

/// The attributes of a look, each behind a blank.
std::string attributes(const Look& look) {
  std::string out;
  const auto word = [&](const char* name, const std::string& value) {
    if (!value.empty()) out += fmt::format(" {}=\"{}\"", name, value);
  };
  const auto number = [&](const char* name, double value) {
    if (value >= 0) out += fmt::format(" {}=\"{:.4g}\"", name, value);
  };
  word("fill", look.fill);
  word("stroke", look.stroke);
  number("stroke-width", look.width);
  number("opacity", look.opacity);
  word("stroke-linecap", look.round ? "round" : "");
  if (!look.clip.empty()) word("clip-path", "url(#" + look.clip + ")");
  return out;
}

/// Pixels with up to two decimals.
std::string pixels(double value) {
  std::string out = fmt::format("{:.2f}", value);
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

std::string rectangle(Point corner, double width, double height, const std::string& look) {
  return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>\n", pixels(corner.x),
                     pixels(corner.y), pixels(width), pixels(height), look);
}

}  // namespace

std::string hex_colour(const Rgb& colour, double light) {
  const auto part = [&](std::size_t k) {
    return static_cast<int>(std::lround(std::clamp(colour[k] * light, 0.0, 255.0)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", part(0), part(1), part(2));
}

Rgb colour_between(std::span<const Rgb> stops, double at) {
  const double place = std::clamp(at, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const std::size_t first = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  Rgb out{};
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = std::lerp(stops[first][k], stops[first + 1][k], place - static_cast<double>(first));
  return out;
}

Path& Path::append(char command, Point to) {
  fmt::format_to(std::back_inserter(commands_), "{}{:.1f} {:.1f}", command, to.x, to.y);
  return *this;
}
Path& Path::close() {
  commands_ += 'Z';
  return *this;
}
Path& Path::right(double by) {
  commands_ += 'h' + pixels(by);
  return *this;
}

Canvas::Canvas(const Size& size) : size_(size) {}

Canvas& Canvas::text(Point at, std::string_view words, Anchor anchor, double font) {
  constexpr std::array anchors{"", " text-anchor=\"middle\"", " text-anchor=\"end\""};
  drawn_ +=
      fmt::format("<text x=\"{}\" y=\"{}\"{}{}>{}</text>\n", pixels(at.x), pixels(at.y),
                  anchors[static_cast<std::size_t>(anchor)],
                  font > 0 ? fmt::format(" font-size=\"{:.3g}\"", font) : "", xml_text(words));
  return *this;
}

Canvas& Canvas::rect(Point corner, double width, double height, const Look& look) {
  drawn_ += rectangle(corner, width, height, attributes(look));
  return *this;
}

Canvas& Canvas::circle(Point centre, double radius, const Look& look) {
  drawn_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", pixels(centre.x),
                        pixels(centre.y), pixels(radius), attributes(look));
  return *this;
}

Canvas& Canvas::path(const Path& path, const Look& look) {
  if (!path.empty())
    drawn_ += fmt::format("<path{} d=\"{}\"/>\n", attributes(look), path.commands());
  return *this;
}

Canvas& Canvas::ramp(Point corner, double width, double height, int n, std::span<const Rgb> stops) {
  const double step = width / n;
  for (int i = 0; i < n; ++i)  // each a little under the next, so that no gap shows
    rect({corner.x + step * i, corner.y}, step + 0.5, height,
         {.fill = hex_colour(colour_between(stops, i / (n - 1.0)))});
  return *this;
}

Canvas& Canvas::begin(Point moved_by, const Look& look) {
  drawn_ += moved_by.x == 0 && moved_by.y == 0
                ? fmt::format("<g{}>\n", attributes(look))
                : fmt::format("<g transform=\"translate({} {})\"{}>\n", pixels(moved_by.x),
                              pixels(moved_by.y), attributes(look));
  return *this;
}

Canvas& Canvas::end() {
  drawn_ += "</g>\n";
  return *this;
}

Canvas& Canvas::clip(const std::string& name, Point corner, double width, double height) {
  drawn_ += fmt::format("<clipPath id=\"{}\">{}</clipPath>\n", name,
                        rectangle(corner, width, height, ""));
  return *this;
}

std::string Canvas::svg() const {
  const double margin = size_.margin;
  const double width = size_.width + 2 * margin, height = size_.height + 2 * margin;
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{0} {0} {1} {2}\" "
             "width=\"{1}\" height=\"{2}\" font-family=\"sans-serif\" font-size=\"{3}\" "
             "stroke-linejoin=\"round\">\n",
             pixels(-margin), pixels(width), pixels(height), pixels(size_.font)) +
         rectangle({-margin, -margin}, width, height, " fill=\"white\"") + drawn_ + "</svg>\n";
}

}  // namespace kit
