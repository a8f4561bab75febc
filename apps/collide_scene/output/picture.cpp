#include "apps/collide_scene/output/files.hpp"
#include "apps/collide_scene/output/view.hpp"
#include "apps/kit/output/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
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
/// From few hits of an object to many.
constexpr std::array<Rgb, 4> hot{{{255, 221, 85}, {248, 149, 64}, {204, 71, 120}, {84, 20, 140}}};
/// From the first owner to the last.
constexpr std::array<Rgb, 4> of_owners{
    {{0, 114, 178}, {0, 158, 115}, {240, 200, 60}, {213, 94, 0}}};
constexpr int n_shades = 10, n_pixels = 900;

using ColourOf = std::function<std::string(const Seen&)>;

double shade(const Seen& triangle) {
  return std::round(triangle.light * n_shades) / n_shades;
}

/// The colours of numbers of hits: by the part of the objects with hits that have fewer, so that no
/// picture is in one colour.
class Heat {
 public:
  explicit Heat(std::span<const std::uint32_t> n_hits) {
    for (const std::uint32_t hits : n_hits)
      if (hits > 0) sorted_.push_back(hits);
    std::ranges::sort(sorted_);
  }
  [[nodiscard]] std::uint32_t least() const { return sorted_.empty() ? 0 : sorted_.front(); }
  [[nodiscard]] std::uint32_t most() const { return sorted_.empty() ? 0 : sorted_.back(); }
  [[nodiscard]] Rgb of(std::uint32_t hits) const {
    const auto [first, last] = std::ranges::equal_range(sorted_, hits);
    const auto n = static_cast<double>(sorted_.size());
    const double middle = static_cast<double>((first - sorted_.begin()) + (last - sorted_.begin()));
    // Few colours, so that neighbours share a path.
    return kit::colour_between(hot, std::round(middle / 2 / n * 12) / 12);
  }

 private:
  std::vector<std::uint32_t> sorted_;
};

/// Triangles from the farthest to the nearest; neighbours in this order share a path if they share
/// the colour.
void draw_triangles(kit::Canvas& canvas, const View& view,
                    const std::vector<std::uint32_t>& visible, const ColourOf& colour_of) {
  std::string colour;
  kit::Path path;
  const auto flush = [&] {
    canvas.path(std::exchange(path, {}), {.fill = colour, .stroke = colour, .width = 0.3});
  };
  for (const std::uint32_t number : visible) {
    const Seen& t = view.triangles()[number];
    if (std::string now = colour_of(t); now != colour) {
      flush();
      colour = std::move(now);
    }
    path.move({t.x[0], t.y[0]}).line({t.x[1], t.y[1]}).line({t.x[2], t.y[2]}).close();
  }
  flush();
}

/// A path per colour, of rows of pixels.
void draw_pixels(kit::Canvas& canvas, const View& view, const ColourOf& colour_of) {
  std::map<std::string, kit::Path> paths;
  for (int y = 0; y < view.height(); ++y)
    for (int x = 0; x < view.width();) {
      const std::uint32_t number = view.at(x, y);
      if (number == View::nothing) {
        ++x;
        continue;
      }
      const std::string colour = colour_of(view.triangles()[number]);
      int end = x + 1;
      while (end < view.width() && view.at(end, y) != View::nothing &&
             colour_of(view.triangles()[view.at(end, y)]) == colour)
        ++end;
      paths[colour].move({static_cast<double>(x), y + 0.5}).right(end - x);
      x = end;
    }
  for (const auto& [colour, path] : paths)
    canvas.path(path, {.fill = "none", .stroke = colour, .width = 1.1});
}

/// A page with the scene, what is below it, and room for two lines; `line`: the place of the second.
struct Page {
  kit::Canvas canvas;
  double width = 0, line = 0;
};
Page page_of(const Scene& scene, const View& view, const ColourOf& colour_of,
             const kit::Path& below = {}) {
  constexpr int legend = 64;
  constexpr std::size_t most_triangles = 30'000;
  const double width = std::max(view.width(), 480), height = view.height() + legend;
  Page page{kit::Canvas({.width = width, .height = height}), width, view.height() + 48.0};
  kit::Canvas& canvas = page.canvas;
  canvas.begin({(width - view.width()) / 2.0, 0});
  canvas.clip("scene", {0, 0}, view.width(), view.height());
  canvas.path(below, {.fill = "none", .stroke = "#777", .width = 0.7, .clip = "scene"});
  const std::vector<std::uint32_t> visible = view.visible();
  if (visible.size() <= most_triangles)
    draw_triangles(canvas, view, visible, colour_of);
  else
    draw_pixels(canvas, view, colour_of);
  canvas.end();
  canvas.text({12, page.line - 24}, scene.description);
  return page;
}

/// The voxels of an edge on the ground of a scene; nothing if they are too many to be seen.
kit::Path ground(const Scene& scene, const View& view, double edge) {
  constexpr double most_lines = 200;
  auto all = tess::collide::no_box<double, 3>();
  for (const auto& box : boxes_of(scene)) all = merged(all, box);
  kit::Path path;
  for (const std::size_t axis : {0U, 1U}) {
    const double first = std::floor(all.lo[axis] / edge), last = std::ceil(all.hi[axis] / edge);
    if (!(edge > 0) || !(last - first <= most_lines)) return {};
    for (double i = first; i <= last; ++i) {
      tess::collide::Point from = all.lo, to = all.lo;
      from[axis] = to[axis] = std::clamp(i * edge, all.lo[axis], all.hi[axis]);
      to[1 - axis] = all.hi[1 - axis];
      path.move(view.pixel(from)).line(view.pixel(to));
    }
  }
  return path;
}

}  // namespace

std::string picture(const Scene& scene, std::span<const std::uint32_t> n_hits) {
  const View view(scene, n_pixels);
  const Heat heat(n_hits);
  auto [canvas, width, line] = page_of(scene, view, [&](const Seen& triangle) {
    const std::uint32_t hits = n_hits[triangle.object];
    if (hits > 0) return kit::hex_colour(heat.of(hits), 0.72 + 0.28 * shade(triangle));
    return kit::hex_colour(
        pale[scene.models.empty() ? 0 : scene.models[triangle.object] % pale.size()],
        0.62 + 0.38 * shade(triangle));
  });
  const auto n_hit = std::ranges::count_if(n_hits, [](std::uint32_t hits) { return hits > 0; });
  canvas.text({12, line}, fmt::format("{} of {} objects collide", n_hit, scene.n_objects()));
  if (heat.most() > 0) {
    constexpr double ramp = 144, n = 24;
    const double left = width - 210, growth = std::log(heat.most()) - std::log(heat.least());
    canvas.text({left - 8, line}, fmt::format("hits per object: {}", heat.least()),
                kit::Anchor::end);
    for (int i = 0; i < n; ++i)  // of as many hits, evenly on a logarithmic scale
      canvas.rect({left + ramp / n * i, line - 11}, ramp / n + 0.5, 12,
                  {.fill = kit::hex_colour(heat.of(static_cast<std::uint32_t>(
                       std::lround(heat.least() * std::exp(growth * i / (n - 1))))))});
    canvas.text({left + ramp + 8, line}, fmt::format("{}", heat.most()));
  }
  return canvas.svg();
}

std::string picture_of_owners(const Scene& scene, std::int32_t n_owners, double voxel_size) {
  const View view(scene, n_pixels);
  const auto owners = static_cast<std::uint64_t>(n_owners);
  const auto of = [&](std::uint64_t owner) {
    return kit::colour_between(of_owners, static_cast<double>(owner) / std::max(1, n_owners - 1));
  };
  const kit::Path voxels = ground(scene, view, voxel_size);
  auto [canvas, width, line] = page_of(
      scene, view,
      [&](const Seen& triangle) {
        const std::uint64_t owner = ((triangle.object + 1) * owners - 1) / scene.n_objects();
        return kit::hex_colour(of(owner), 0.6 + 0.4 * shade(triangle));
      },
      voxels);
  canvas.text({12, line}, fmt::format("voxels of {:.4g}{}; owners, PEs 0 to {}", voxel_size,
                                      voxels.empty() ? "" : ": squares", n_owners - 1));
  for (std::uint64_t owner = 0; owner < std::min<std::uint64_t>(owners, 16); ++owner)
    canvas.rect(
        {width - 210 + 12.0 * static_cast<double>(owner), line - 11}, 11, 12,
        {.fill = kit::hex_colour(of(owner * owners / std::min<std::uint64_t>(owners, 16)))});
  return canvas.svg();
}

}  // namespace collide_scene
