#include "apps/collide_scene/output/picture.hpp"

#include "apps/collide_scene/output/view.hpp"
#include "apps/kit/quoting.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <map>

namespace collide_scene {
namespace {

using Rgb = std::array<double, 3>;

constexpr std::array<Rgb, 6> pale{{{176, 196, 222},
                                   {188, 211, 178},
                                   {214, 200, 226},
                                   {222, 213, 187},
                                   {178, 214, 214},
                                   {205, 205, 210}}};
constexpr std::array<Rgb, 4> hot{{{255, 221, 85}, {253, 160, 50}, {227, 66, 40}, {128, 8, 40}}};
constexpr int n_shades = 10;

/// From 0, one hit, to 1, the most hits of an object.
Rgb hot_at(double t) {
  const double at = t * (hot.size() - 1);
  const std::size_t first = std::min<std::size_t>(static_cast<std::size_t>(at), hot.size() - 2);
  Rgb out{};
  for (std::size_t k = 0; k < 3; ++k)
    out[k] =
        hot[first][k] + (at - static_cast<double>(first)) * (hot[first + 1][k] - hot[first][k]);
  return out;
}

std::string hex(const Rgb& colour, double light) {
  std::array<int, 3> rgb{};
  for (std::size_t k = 0; k < 3; ++k) rgb[k] = static_cast<int>(std::lround(colour[k] * light));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

class Colours {
 public:
  Colours(const Scene& scene, std::span<const std::uint32_t> n_hits)
      : scene_(scene),
        n_hits_(n_hits),
        most_(n_hits.empty() ? 0 : *std::ranges::max_element(n_hits)) {}

  [[nodiscard]] std::uint32_t most() const { return most_; }
  [[nodiscard]] std::string of(const Seen& triangle) const {
    const std::uint32_t hits = n_hits_[triangle.object];
    const double shade = std::round(triangle.light * n_shades) / n_shades;
    if (hits == 0)
      return hex(pale[scene_.models.empty() ? 0 : scene_.models[triangle.object] % pale.size()],
                 0.62 + 0.38 * shade);
    // Few colours, so that neighbours share a path.
    const double t = most_ > 1 ? std::log(hits) / std::log(most_) : 1;
    return hex(hot_at(std::round(t * 12) / 12), 0.72 + 0.28 * shade);
  }

 private:
  const Scene& scene_;
  std::span<const std::uint32_t> n_hits_;
  std::uint32_t most_;
};

/// Triangles from the farthest to the nearest; neighbours in this order share a path if they share
/// the colour.
std::string triangles_svg(const View& view, const std::vector<std::uint32_t>& visible,
                          const Colours& colours) {
  std::string out = "<g stroke-width=\"0.3\" stroke-linejoin=\"round\">\n", colour, path;
  const auto flush = [&] {
    if (!path.empty())
      out += fmt::format("<path fill=\"{0}\" stroke=\"{0}\" d=\"{1}\"/>\n", colour, path);
    path.clear();
  };
  for (const std::uint32_t number : visible) {
    const Seen& t = view.triangles()[number];
    if (std::string now = colours.of(t); now != colour) {
      flush();
      colour = std::move(now);
    }
    fmt::format_to(std::back_inserter(path), "M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z", t.x[0],
                   t.y[0], t.x[1], t.y[1], t.x[2], t.y[2]);
  }
  flush();
  return out + "</g>\n";
}

/// A path per colour, of rows of pixels.
std::string pixels_svg(const View& view, const Colours& colours) {
  std::map<std::string, std::string> paths;
  for (int y = 0; y < view.height(); ++y)
    for (int x = 0; x < view.width();) {
      const std::uint32_t number = view.at(x, y);
      if (number == View::nothing) {
        ++x;
        continue;
      }
      const std::string colour = colours.of(view.triangles()[number]);
      int end = x + 1;
      while (end < view.width() && view.at(end, y) != View::nothing &&
             colours.of(view.triangles()[view.at(end, y)]) == colour)
        ++end;
      fmt::format_to(std::back_inserter(paths[colour]), "M{} {}h{}", x, y, end - x);
      x = end;
    }
  std::string out = "<g fill=\"none\" stroke-width=\"1.1\" transform=\"translate(0 0.5)\">\n";
  for (const auto& [colour, path] : paths)
    out += fmt::format("<path stroke=\"{}\" d=\"{}\"/>\n", colour, path);
  return out + "</g>\n";
}

}  // namespace

std::string picture(const Scene& scene, std::span<const std::uint32_t> n_hits) {
  constexpr int n_pixels = 900, legend = 64;
  constexpr std::size_t most_triangles = 30'000;
  const View view(scene, n_pixels);
  const Colours colours(scene, n_hits);
  const int width = std::max(view.width(), 480), height = view.height() + legend;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "font-family=\"sans-serif\" font-size=\"14\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n<g transform=\"translate({2} 0)\">\n",
      width, height, (width - view.width()) / 2);
  const std::vector<std::uint32_t> visible = view.visible();
  out += visible.size() <= most_triangles ? triangles_svg(view, visible, colours)
                                          : pixels_svg(view, colours);
  const auto n_hit = std::ranges::count_if(n_hits, [](std::uint32_t hits) { return hits > 0; });
  out += fmt::format("</g>\n<text x=\"12\" y=\"{}\">{}</text>\n", view.height() + 24,
                     kit::xml_text(scene.description));
  out += fmt::format("<text x=\"12\" y=\"{}\">{} of {} objects collide</text>\n",
                     view.height() + 48, n_hit, scene.n_objects());
  if (colours.most() > 0) {
    constexpr int n_steps = 24, step = 6;
    const int left = width - 210, line = view.height() + 48;
    out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">hits per object: 1</text>\n",
                       left - 8, line);
    for (int i = 0; i < n_steps; ++i)
      out += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"6.5\" height=\"12\" fill=\"{}\"/>\n",
                         left + step * i, line - 11, hex(hot_at(i / (n_steps - 1.0)), 1));
    out += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", left + step * n_steps + 8, line,
                       colours.most());
  }
  return out + "</svg>\n";
}

}  // namespace collide_scene
