#include "apps/collide_scene/output/files.hpp"
#include "apps/collide_scene/output/view.hpp"
#include "apps/kit/output/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <utility>

namespace collide_scene {
namespace {

using kit::Rgb;

constexpr std::array<Rgb, 6> pale{{{176, 196, 222},
                                   {188, 211, 178},
                                   {214, 200, 226},
                                   {222, 213, 187},
                                   {178, 214, 214},
                                   {205, 205, 210}}};
/// From one hit to the most hits of an object.
constexpr std::array<Rgb, 4> hot{{{255, 221, 85}, {253, 160, 50}, {227, 66, 40}, {128, 8, 40}}};
constexpr int n_shades = 10;

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
      return kit::hex_colour(
          pale[scene_.models.empty() ? 0 : scene_.models[triangle.object] % pale.size()],
          0.62 + 0.38 * shade);
    // Few colours, so that neighbours share a path.
    const double t = most_ > 1 ? std::log(hits) / std::log(most_) : 1;
    return kit::hex_colour(kit::colour_between(hot, std::round(t * 12) / 12), 0.72 + 0.28 * shade);
  }

 private:
  const Scene& scene_;
  std::span<const std::uint32_t> n_hits_;
  std::uint32_t most_;
};

/// Triangles from the farthest to the nearest; neighbours in this order share a path if they share
/// the colour.
void draw_triangles(kit::Canvas& canvas, const View& view,
                    const std::vector<std::uint32_t>& visible, const Colours& colours) {
  std::string colour;
  kit::Path path;
  const auto flush = [&] {
    canvas.path(std::exchange(path, {}), {.fill = colour, .stroke = colour, .width = 0.3});
  };
  for (const std::uint32_t number : visible) {
    const Seen& t = view.triangles()[number];
    if (std::string now = colours.of(t); now != colour) {
      flush();
      colour = std::move(now);
    }
    path.move({t.x[0], t.y[0]}).line({t.x[1], t.y[1]}).line({t.x[2], t.y[2]}).close();
  }
  flush();
}

/// A path per colour, of rows of pixels.
void draw_pixels(kit::Canvas& canvas, const View& view, const Colours& colours) {
  std::map<std::string, kit::Path> paths;
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
      paths[colour].move({static_cast<double>(x), y + 0.5}).right(end - x);
      x = end;
    }
  for (const auto& [colour, path] : paths)
    canvas.path(path, {.fill = "none", .stroke = colour, .width = 1.1});
}

}  // namespace

std::string picture(const Scene& scene, std::span<const std::uint32_t> n_hits) {
  constexpr int n_pixels = 900, legend = 64;
  constexpr std::size_t most_triangles = 30'000;
  const View view(scene, n_pixels);
  const Colours colours(scene, n_hits);
  const int width = std::max(view.width(), 480), height = view.height() + legend;
  kit::Canvas canvas(
      {.width = static_cast<double>(width), .height = static_cast<double>(height), .font = 14});
  canvas.begin({(width - view.width()) / 2.0, 0});
  const std::vector<std::uint32_t> visible = view.visible();
  if (visible.size() <= most_triangles)
    draw_triangles(canvas, view, visible, colours);
  else
    draw_pixels(canvas, view, colours);
  canvas.end();
  const double line = view.height() + 48;
  const auto n_hit = std::ranges::count_if(n_hits, [](std::uint32_t hits) { return hits > 0; });
  canvas.text({12, line - 24}, scene.description);
  canvas.text({12, line}, fmt::format("{} of {} objects collide", n_hit, scene.n_objects()));
  if (colours.most() > 0) {
    constexpr double ramp = 144;
    const double left = width - 210;
    canvas.text({left - 8, line}, "hits per object: 1", kit::Anchor::end);
    canvas.ramp({left, line - 11}, ramp, 12, 24, hot);
    canvas.text({left + ramp + 8, line}, fmt::format("{}", colours.most()));
  }
  return canvas.svg();
}

}  // namespace collide_scene
