#include "apps/kit/output/canvas.hpp"
#include "apps/kit/output/contour.hpp"
#include "apps/kit/output/ticks.hpp"
#include "apps/particles/output/files.hpp"
#include "collide/dn_field/compressed.hpp"

#include <algorithm>
#include <array>
#include <fmt/core.h>
#include <map>

namespace particles {
namespace {
using namespace tess::dn;
using kit::Point;

// Pixels.
constexpr double frame_width = 560, left = 64, right = 16, top = 34, bottom = 44;

/// A frame with axes: a window of space seen along an axis, the two others to the right and up.
class Frame2D {
 public:
  Frame2D(int axis, const Bounds& window)
      : axis_(axis), right_(axis == 0 ? 1 : 0), up_(axis == 2 ? 1 : 2), low_(seen(window.low)) {
    const Point high = seen(window.high);
    scale_ = frame_width / (high.x - low_.x);
    height_ = (high.y - low_.y) * scale_;
  }
  [[nodiscard]] double width() const { return left + frame_width + right; }
  [[nodiscard]] double height() const { return top + height_ + bottom; }

  [[nodiscard]] Point seen(Vec3 p) const { return {component(p, right_), component(p, up_)}; }
  [[nodiscard]] bool holds(Vec3 p) const {
    const double x = (seen(p).x - low_.x) * scale_, y = (seen(p).y - low_.y) * scale_;
    return x >= 0 && x <= frame_width && y >= 0 && y <= height_;
  }
  /// Where a point of the plane is drawn.
  [[nodiscard]] Point at(Point p) const {
    return {left + (p.x - low_.x) * scale_, top + height_ - (p.y - low_.y) * scale_};
  }
  /// The name of the region inside of the frame.
  [[nodiscard]] std::string clip() const { return fmt::format("c{}", axis_); }
  /// Draws closed lines, cut where the frame ends.
  void draw_closed(kit::Canvas& canvas, const std::vector<std::vector<Point>>& lines,
                   kit::Look look) const {
    kit::Path path;
    for (const std::vector<Point>& line : lines) {
      for (std::size_t i = 0; i < line.size(); ++i)
        i == 0 ? path.move(at(line[i])) : path.line(at(line[i]));
      path.close();
    }
    look.clip = clip();
    canvas.path(path, look);
  }
  /// Draws the border, ticks with numbers, and the names of the axes.
  void draw_axes(kit::Canvas& canvas) const {
    using kit::Anchor;
    canvas.rect({left, top}, frame_width, height_, {.fill = "none", .stroke = "black"});
    const double step = kit::tick_step(std::max(frame_width, height_) / scale_);
    const double base = top + height_;
    // Far from the origin labels differ in their last digits only; long ones are set smaller.
    const double farthest = std::max({std::abs(low_.x), std::abs(low_.x + frame_width / scale_),
                                      std::abs(low_.y), std::abs(low_.y + height_ / scale_)});
    const int digits =
        std::clamp(2 + static_cast<int>(std::ceil(std::log10(farthest / step))), 6, 17);
    const double font_size = std::min(12.0, 96.0 / (digits + 2));
    const auto each_tick = [&](double from, double length, const auto& draw) {
      constexpr int most_ticks = 20;
      const double first = std::ceil(from / step);
      for (int i = 0; i < most_ticks && (first + i) * step <= from + length; ++i)
        draw((first + i) * step, fmt::format("{:.{}g}", (first + i) * step, digits));
    };
    each_tick(low_.x, frame_width / scale_, [&](double tick, const std::string& number) {
      const double x = left + (tick - low_.x) * scale_;
      canvas.path(kit::Path().move({x, base}).line({x, base + 5}), {.stroke = "black"});
      canvas.text({x, base + 18}, number, Anchor::middle, font_size);
    });
    each_tick(low_.y, height_ / scale_, [&](double tick, const std::string& number) {
      const double y = base - (tick - low_.y) * scale_;
      canvas.path(kit::Path().move({left, y}).line({left - 5, y}), {.stroke = "black"});
      canvas.text({left - 8, y + 4}, number, Anchor::end, font_size);
    });
    canvas.text({left + frame_width / 2, base + 36}, {&"xyz"[right_], 1}, Anchor::middle);
    canvas.text({14, top + height_ / 2}, {&"xyz"[up_], 1});
  }
  /// Draws the frame with what `draw` draws in it, `x` pixels to the right.
  template <class Draw>
  void place(kit::Canvas& canvas, double x, const Draw& draw) const {
    canvas.begin({x, 0});
    canvas.clip(clip(), {left, top}, frame_width, height_);
    draw();
    draw_axes(canvas);
    canvas.end();
  }

 private:
  int axis_, right_, up_;
  Point low_;
  double scale_ = 1, height_ = 0;
};

/// The border of a surface's shadow, seen along the frame's axis: every triangle is turned to face
/// the viewer; edges between two triangles then cancel, unless both lie on one side of the edge.
/// The lines that are left fill the shadow by winding number.
std::vector<std::vector<Point>> shadow(const Surface& surface, const Frame& frame,
                                       const Frame2D& in) {
  std::vector<Point> points;
  for (const Vec3 p : surface.vertices) points.push_back(in.seen(frame.to_world(p)));
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::multimap<std::uint32_t, std::uint32_t> edges;
  std::map<Edge, int> count;
  for (auto [a, b, c] : surface.triangles) {
    const Point &p = points[a], &q = points[b], &r = points[c];
    const double area = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    if (area == 0) continue;
    if (area < 0) std::swap(b, c);
    for (const auto& [from, to] : {Edge{a, b}, Edge{b, c}, Edge{c, a}})
      ++count[{from, to}], --count[{to, from}];
  }
  for (const auto& [edge, n] : count)
    for (int i = 0; i < n; ++i) edges.insert(edge);
  std::vector<std::vector<Point>> lines;
  while (!edges.empty()) {
    std::vector<Point>& line = lines.emplace_back();
    for (auto now = edges.begin(); now != edges.end();) {
      line.push_back(points[now->first]);
      const std::uint32_t to = now->second;
      edges.erase(now);
      now = edges.find(to);
    }
  }
  return lines;
}

/// Of the time `part` × `end`: from dark blue over green and orange to red.
std::string colour(double part, std::size_t end) {
  constexpr std::array<kit::Rgb, 4> stops{
      {{40, 50, 160}, {0, 150, 120}, {240, 160, 0}, {200, 20, 40}}};
  return kit::hex_colour(kit::colour_between(stops, end > 0 ? part / static_cast<double>(end) : 0));
}

/// Draws the paths between snapshots in as many colours as there are pieces, and dots at their
/// ends.
void draw_paths(kit::Canvas& canvas, const Frame2D& frame, const std::vector<Snapshot>& snapshots,
                const std::vector<std::size_t>& dots) {
  constexpr std::size_t most_pieces = 16;
  const std::size_t last = snapshots.size() - 1, n_pieces = std::min(most_pieces, last);
  for (std::size_t piece = 0; piece < n_pieces; ++piece) {
    const std::size_t from = last * piece / n_pieces, to = last * (piece + 1) / n_pieces;
    kit::Path path;
    for (std::size_t p = 0; p < snapshots[from].samples.size(); ++p) {
      bool goes_on = false;  // from where it was last; not where it left the frame between
      for (std::size_t i = from; i <= to; ++i) {
        const Vec3 position = snapshots[i].samples[p].position;
        const bool held = frame.holds(position);
        if (held) {
          const Point at = frame.at(frame.seen(position));
          goes_on ? path.line(at) : path.move(at);
        }
        goes_on = held;
      }
    }
    canvas.path(path, {.fill = "none",
                       .stroke = colour(static_cast<double>(piece) + 0.5, n_pieces),
                       .width = 0.8,
                       .opacity = 0.7});
  }
  for (const std::size_t dot : dots) {
    kit::Path path;
    for (const Sample& sample : snapshots[dot].samples)
      if (frame.holds(sample.position)) path.move(frame.at(frame.seen(sample.position))).right(0);
    canvas.path(path,
                {.stroke = colour(static_cast<double>(dot), last), .width = 4, .round = true});
  }
}

/// A layer of voxels across an axis.
class Layer {
 public:
  Layer(const Field& field, int axis, double at)
      : field_(field),
        axis_(axis),
        index_(std::round((at - component(field.grid.origin, axis)) / field.grid.cell)) {}

  [[nodiscard]] const Field& field() const { return field_; }
  [[nodiscard]] int n_across() const { return count(across()); }
  [[nodiscard]] int n_up() const { return count(up()); }
  [[nodiscard]] Vec3 centre(int i, int j) const {
    const auto [x, y, z] = voxel(i, j);
    return field_.grid.centre(x, y, z);
  }
  [[nodiscard]] double distance(int i, int j) const {
    const auto [x, y, z] = voxel(i, j);
    return static_cast<double>(voxel_distance(field_, x, y, z));
  }
  [[nodiscard]] Vec3 normal(int i, int j) const {
    const auto [x, y, z] = voxel(i, j);
    return voxel_normal(field_, x, y, z);
  }
  /// The coordinate of the layer along its axis.
  [[nodiscard]] double place() const {
    return component(field_.grid.origin, axis_) + index_ * field_.grid.cell;
  }

 private:
  [[nodiscard]] int across() const { return axis_ == 0 ? 1 : 0; }
  [[nodiscard]] int up() const { return axis_ == 2 ? 1 : 2; }
  [[nodiscard]] int count(int of) const { return field_.grid.n[static_cast<std::size_t>(of)]; }
  [[nodiscard]] std::array<int, 3> voxel(int i, int j) const {
    std::array<int, 3> of{};
    of[static_cast<std::size_t>(axis_)] = static_cast<int>(index_);
    of[static_cast<std::size_t>(across())] = i;
    of[static_cast<std::size_t>(up())] = j;
    return of;
  }

  const Field& field_;
  int axis_;
  double index_;
};

/// The outlines of where the distance is below a level.
std::vector<std::vector<Point>> below(const Layer& layer, const Frame2D& frame, double level) {
  auto lines = kit::contours(
      layer.n_across(), layer.n_up(), [&](int i, int j) { return layer.distance(i, j); }, level);
  const Grid& grid = layer.field().grid;
  const Point origin = frame.seen(grid.origin);
  for (auto& line : lines)
    for (Point& p : line) p = {origin.x + grid.cell * p.x, origin.y + grid.cell * p.y};
  return lines;
}

/// Arrows along the normals.
kit::Path normals(const Layer& layer, const Frame2D& frame) {
  constexpr int arrows = 20;
  const int stride = std::max(1, layer.n_across() / arrows);
  const double length = 0.8 * stride * layer.field().grid.cell;
  kit::Path path;
  for (int j = stride / 2; j < layer.n_up(); j += stride)
    for (int i = stride / 2; i < layer.n_across(); i += stride) {
      const Vec3 normal = layer.normal(i, j);
      if (normal == Vec3{}) continue;
      const Point foot = frame.seen(layer.centre(i, j)), along = frame.seen(length * normal);
      const Point tip{foot.x + along.x, foot.y + along.y};
      const auto barb = [&](double side) {
        return frame.at(
            {tip.x - 0.3 * along.x - side * along.y, tip.y - 0.3 * along.y + side * along.x});
      };
      path.move(frame.at(foot)).line(frame.at(tip));
      path.move(barb(0.15)).line(frame.at(tip)).line(barb(-0.15));
    }
  return path;
}

double largest(Vec3 size) {
  return std::max({std::abs(size.x), std::abs(size.y), std::abs(size.z)});
}

/// The objects and where the particles begin, or all paths where that is one point; and a part of
/// that around.
Bounds window_of(const Scene& scene, const std::vector<Snapshot>& snapshots) {
  Bounds window;
  for (const SceneObject& object : scene.objects)
    each_corner(object.surface, [&](Vec3 p) { window.extend(object.frame.to_world(p)); });
  for (const Sample& sample : snapshots.front().samples) window.extend(sample.position);
  if (window.low == window.high)
    for (const Snapshot& snapshot : snapshots)
      for (const Sample& sample : snapshot.samples)
        if (std::isfinite(norm(sample.position))) window.extend(sample.position);
  // Far from the origin a margin must not be lost in rounding.
  const double size = largest(window.size());
  const double reach = std::max(largest(window.low), largest(window.high));
  const double margin = std::max({0.3 * size, (size > 0 ? 1e-9 : 1e-3) * reach, 1e-9});
  const Vec3 around{margin, margin, margin};
  return {window.low - around, window.high + around};
}

}  // namespace

std::string slice_svg(const Field& field, int axis, double at) {
  const Layer layer(field, axis, at);
  const Frame2D frame(axis, field.grid.box());
  kit::Canvas canvas({.width = frame.width(), .height = frame.height()});
  canvas.text({left, 20},
              fmt::format("distance and normals at {} = {:.6g}; a shade is {:.4g} wide, black is "
                          "the surface",
                          "xyz"[axis], layer.place(), field.thickness / 6));
  frame.place(canvas, 0, [&] {
    // From the outside in, each over the last: blue outside of the surface, grey inside.
    for (int step = 6; step >= -6; --step) {
      const double light = 130 + 20 * step, grey = 120 + 10 * step;
      kit::Look look{.fill = kit::hex_colour(step > 0 ? kit::Rgb{light, 165.0 + 13 * step, 255}
                                                      : kit::Rgb{grey, grey, grey})};
      if (step == 0) look.stroke = "black", look.width = 1.5;
      frame.draw_closed(canvas, below(layer, frame, step * field.thickness / 6), look);
    }
    if (field.content() == Content::distance_and_normal)
      canvas.path(normals(layer, frame),
                  {.fill = "none", .stroke = "black", .width = 0.8, .clip = frame.clip()});
  });
  return canvas.svg();
}

std::string paths_svg(const Scene& scene, const std::vector<Snapshot>& snapshots) {
  const Bounds window = window_of(scene, snapshots);
  constexpr std::size_t most_dots = 5;
  const std::size_t last = snapshots.size() - 1, n_dots = std::min(most_dots, last);
  std::vector<std::size_t> dots;
  for (std::size_t i = 0; i <= n_dots; ++i) dots.push_back(n_dots == 0 ? 0 : last * i / n_dots);
  const auto time = [&](std::size_t snapshot) { return snapshots[snapshot].step * scene.dt; };
  const double end = time(last);
  std::vector<Frame2D> frames;
  for (const int axis : scene.outputs.axes) frames.emplace_back(axis, window);
  double width = 0, height = 0;
  for (const Frame2D& frame : frames) {
    width += frame.width();
    height = std::max(height, frame.height());
  }
  kit::Canvas canvas({.width = width, .height = height});
  for (std::size_t i = 0; i < dots.size(); ++i) {
    const double x = left + 70.0 * static_cast<double>(i);
    canvas.circle({x + 4, 16}, 4, {.fill = colour(static_cast<double>(dots[i]), last)});
    canvas.text({x + 12, 20}, fmt::format("t = {:.4g}", time(dots[i])));
  }
  bool moved = false;
  double x = 0;
  for (const Frame2D& frame : frames) {
    frame.place(canvas, x, [&] {
      for (const SceneObject& object : scene.objects) {
        Frame stands = object.frame;
        frame.draw_closed(canvas, shadow(object.surface, stands, frame), {.fill = "#bbb"});
        if (!stands.is_moving()) continue;
        moved = true;
        stands.advance(end);
        frame.draw_closed(canvas, shadow(object.surface, stands, frame),
                          {.fill = "none", .stroke = "#888", .width = 0.8});
      }
      draw_paths(canvas, frame, snapshots, dots);
    });
    x += frame.width();
  }
  if (moved)
    canvas.text({left + 70.0 * static_cast<double>(dots.size()), 20},
                fmt::format("outline: t = {:.4g}", end));
  return canvas.svg();
}

}  // namespace particles
