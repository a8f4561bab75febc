#include "apps/particles/output/picture.hpp"

#include "apps/kit/contour.hpp"
#include "apps/kit/ticks.hpp"
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
  /// The command of a path: M moves there, L draws a line.
  [[nodiscard]] std::string to(char command, Point p) const {
    return fmt::format("{}{:.1f} {:.1f}", command, left + (p.x - low_.x) * scale_,
                       top + height_ - (p.y - low_.y) * scale_);
  }
  /// Closed lines, cut where the frame ends.
  [[nodiscard]] std::string closed(const std::vector<std::vector<Point>>& lines,
                                   const char* look) const {
    std::string path;
    for (const std::vector<Point>& line : lines) {
      for (std::size_t i = 0; i < line.size(); ++i) path += to(i == 0 ? 'M' : 'L', line[i]);
      path += "Z";
    }
    return path.empty()
               ? ""
               : fmt::format("<path clip-path=\"url(#c{})\" {} d=\"{}\"/>\n", axis_, look, path);
  }
  /// The border, ticks with numbers, and the names of the axes.
  [[nodiscard]] std::string axes() const {
    std::string out = fmt::format(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{:.1f}\" "
        "fill=\"none\" stroke=\"#000\"/>\n",
        left, top, frame_width, height_);
    const double step = kit::tick_step(std::max(frame_width, height_) / scale_);
    const double base = top + height_;
    // Far from the origin labels differ in their last digits only; long ones are set smaller.
    const double farthest = std::max({std::abs(low_.x), std::abs(low_.x + frame_width / scale_),
                                      std::abs(low_.y), std::abs(low_.y + height_ / scale_)});
    const int digits =
        std::clamp(2 + static_cast<int>(std::ceil(std::log10(farthest / step))), 6, 17);
    const double font_size = std::min(12.0, 96.0 / (digits + 2));
    const auto each_tick = [step](double from, double length, const auto& draw) {
      constexpr int most_ticks = 20;
      const double first = std::ceil(from / step);
      for (int i = 0; i < most_ticks && (first + i) * step <= from + length; ++i)
        draw((first + i) * step);
    };
    each_tick(low_.x, frame_width / scale_, [&](double at) {
      out += fmt::format(
          "<path d=\"M{0:.1f} {1:.1f}v5\" stroke=\"#000\"/><text x=\"{0:.1f}\" "
          "y=\"{2:.1f}\" font-size=\"{5:.3g}\" text-anchor=\"middle\">{3:.{4}g}</text>\n",
          left + (at - low_.x) * scale_, base, base + 18, at, digits, font_size);
    });
    each_tick(low_.y, height_ / scale_, [&](double at) {
      const double y = base - (at - low_.y) * scale_;
      out += fmt::format(
          "<path d=\"M{0} {1:.1f}h-5\" stroke=\"#000\"/><text x=\"{2}\" "
          "y=\"{3:.1f}\" font-size=\"{6:.3g}\" text-anchor=\"end\">{4:.{5}g}</text>\n",
          left, y, left - 8, y + 4, at, digits, font_size);
    });
    out += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                       left + frame_width / 2, base + 36, "xyz"[right_]);
    out += fmt::format("<text x=\"14\" y=\"{:.1f}\">{}</text>\n", top + height_ / 2, "xyz"[up_]);
    return out;
  }
  /// The frame with what is drawn in it, `x` pixels to the right.
  [[nodiscard]] std::string placed(double x, const std::string& drawn) const {
    return fmt::format(
        "<g transform=\"translate({:.0f},0)\">\n<clipPath id=\"c{}\"><rect x=\"{}\" "
        "y=\"{}\" width=\"{}\" height=\"{:.1f}\"/></clipPath>\n{}{}</g>\n",
        x, axis_, left, top, frame_width, height_, drawn, axes());
  }

 private:
  int axis_, right_, up_;
  Point low_;
  double scale_ = 1, height_ = 0;
};

std::string svg(double width, double height, const std::string& title, const std::string& drawn) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{2}{3}</svg>\n",
      width, height, title, drawn);
}

std::string text(double x, const std::string& words) {
  return fmt::format("<text x=\"{:.0f}\" y=\"20\">{}</text>\n", x, words);
}

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
  constexpr std::array<std::array<double, 3>, 4> anchors{
      {{40, 50, 160}, {0, 150, 120}, {240, 160, 0}, {200, 20, 40}}};
  const double at = end > 0 ? 3 * part / static_cast<double>(end) : 0;
  const auto i = std::min<std::size_t>(2, static_cast<std::size_t>(at));
  std::array<int, 3> rgb{};
  for (std::size_t k = 0; k < 3; ++k)
    rgb[k] =
        static_cast<int>(std::lerp(anchors[i][k], anchors[i + 1][k], at - static_cast<double>(i)));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

/// The paths between snapshots in as many colours as there are pieces, and dots at their ends.
std::string paths(const Frame2D& frame, const std::vector<Snapshot>& snapshots,
                  const std::vector<std::size_t>& dots) {
  constexpr std::size_t most_pieces = 16;
  const std::size_t last = snapshots.size() - 1, n_pieces = std::min(most_pieces, last);
  std::string out;
  for (std::size_t piece = 0; piece < n_pieces; ++piece) {
    const std::size_t from = last * piece / n_pieces, to = last * (piece + 1) / n_pieces;
    std::string path;
    for (std::size_t p = 0; p < snapshots[from].samples.size(); ++p) {
      bool goes_on = false;  // from where it was last; not where it left the frame between
      for (std::size_t i = from; i <= to; ++i) {
        const Vec3 at = snapshots[i].samples[p].position;
        const bool held = frame.holds(at);
        if (held) path += frame.to(goes_on ? 'L' : 'M', frame.seen(at));
        goes_on = held;
      }
    }
    out += fmt::format(
        "<path fill=\"none\" stroke=\"{}\" stroke-width=\"0.8\" "
        "stroke-opacity=\"0.7\" d=\"{}\"/>\n",
        colour(static_cast<double>(piece) + 0.5, n_pieces), path);
  }
  for (std::size_t i = 0; i < dots.size(); ++i) {
    std::string path;
    for (const Sample& sample : snapshots[dots[i]].samples)
      if (frame.holds(sample.position)) path += frame.to('M', frame.seen(sample.position)) + "h0";
    out +=
        fmt::format("<path stroke=\"{}\" stroke-width=\"4\" stroke-linecap=\"round\" d=\"{}\"/>\n",
                    colour(static_cast<double>(dots[i]), last), path);
  }
  return out;
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

/// A path of arrows along the normals.
std::string normals(const Layer& layer, const Frame2D& frame) {
  constexpr int arrows = 20;
  const int stride = std::max(1, layer.n_across() / arrows);
  const double length = 0.8 * stride * layer.field().grid.cell;
  std::string path;
  for (int j = stride / 2; j < layer.n_up(); j += stride)
    for (int i = stride / 2; i < layer.n_across(); i += stride) {
      const Vec3 normal = layer.normal(i, j);
      if (normal == Vec3{}) continue;
      const Point foot = frame.seen(layer.centre(i, j)), along = frame.seen(length * normal);
      const Point tip{foot.x + along.x, foot.y + along.y};
      const auto barb = [&](char command, double side) {
        return frame.to(command, {tip.x - 0.3 * along.x - side * along.y,
                                  tip.y - 0.3 * along.y + side * along.x});
      };
      path += frame.to('M', foot) + frame.to('L', tip) + barb('M', 0.15) + frame.to('L', tip) +
              barb('L', -0.15);
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
  // From the outside in, each over the last: blue outside of the surface, grey inside.
  std::string drawn;
  for (int step = 6; step >= -6; --step) {
    const int light = 130 + 20 * step, grey = 120 + 10 * step;
    const std::string fill = step > 0 ? fmt::format("#{:02x}{:02x}ff", light, 165 + 13 * step)
                                      : fmt::format("#{0:02x}{0:02x}{0:02x}", grey);
    const std::string look = fmt::format("fill=\"{}\"{}", fill,
                                         step == 0 ? " stroke=\"#000\" stroke-width=\"1.5\"" : "");
    drawn += frame.closed(below(layer, frame, step * field.thickness / 6), look.c_str());
  }
  if (field.content() == Content::distance_and_normal)
    drawn += fmt::format(
        "<path clip-path=\"url(#c{})\" fill=\"none\" stroke=\"#000\" stroke-width=\"0.8\" "
        "d=\"{}\"/>\n",
        axis, normals(layer, frame));
  return svg(
      frame.width(), frame.height(),
      text(left, fmt::format("distance and normals at {} = {:.6g}; a shade is {:.4g} wide, black "
                             "is the surface",
                             "xyz"[axis], layer.place(), field.thickness / 6)),
      frame.placed(0, drawn));
}

std::string paths_svg(const Scene& scene, const std::vector<Snapshot>& snapshots) {
  const Bounds window = window_of(scene, snapshots);
  constexpr std::size_t most_dots = 5;
  const std::size_t last = snapshots.size() - 1, n_dots = std::min(most_dots, last);
  std::vector<std::size_t> dots;
  for (std::size_t i = 0; i <= n_dots; ++i) dots.push_back(n_dots == 0 ? 0 : last * i / n_dots);
  const auto time = [&](std::size_t snapshot) { return snapshots[snapshot].step * scene.dt; };
  const double end = time(last);
  double width = 0, height = 0;
  std::string drawn, key;
  for (std::size_t i = 0; i < dots.size(); ++i) {
    const double x = left + 70.0 * static_cast<double>(i);
    key += fmt::format("<circle cx=\"{:.0f}\" cy=\"16\" r=\"4\" fill=\"{}\"/>", x + 4,
                       colour(static_cast<double>(dots[i]), last));
    key += text(x + 12, fmt::format("t = {:.4g}", time(dots[i])));
  }
  bool moved = false;
  for (const int axis : scene.outputs.axes) {
    const Frame2D frame(axis, window);
    std::string objects;
    for (const SceneObject& object : scene.objects) {
      Frame stands = object.frame;
      objects += frame.closed(shadow(object.surface, stands, frame), "fill=\"#bbb\"");
      if (!stands.is_moving()) continue;
      moved = true;
      stands.advance(end);
      objects += frame.closed(shadow(object.surface, stands, frame),
                              "fill=\"none\" stroke=\"#888\" stroke-width=\"0.8\"");
    }
    drawn += frame.placed(width, objects + paths(frame, snapshots, dots));
    width += frame.width();
    height = std::max(height, frame.height());
  }
  if (moved)
    key += text(left + 70.0 * static_cast<double>(dots.size()),
                fmt::format("outline: t = {:.4g}", end));
  return svg(width, height, key, drawn);
}

}  // namespace particles
