#include "apps/particles/output/picture.hpp"

#include "collide/dn_field/normal_code.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <fmt/core.h>
#include <map>

namespace particles {
namespace {
using namespace tess::dn;

/// Looking along an axis: the two others, to the right and up.
struct View {
  int axis = 2, right = 0, up = 1;
  explicit View(int along) : axis(along), right(along == 0 ? 1 : 0), up(along == 2 ? 1 : 2) {}
};

/// A drawing of so many units of space, `pixels` wide; y grows upward.
class Canvas {
 public:
  Canvas(double left, double bottom, double width, double height)
      : left_(left), top_(bottom + height), scale_(pixels / width) {
    out_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
        "width=\"{0:.0f}\" "
        "height=\"{1:.0f}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        pixels, height * scale_);
  }
  [[nodiscard]] double x(double right) const { return (right - left_) * scale_; }
  [[nodiscard]] double y(double up) const { return (top_ - up) * scale_; }
  /// What is drawn after boxes lies on them.
  void raw(const std::string& text) {
    flush();
    out_ += text;
  }
  /// Boxes of one fill are one path.
  void box(double right, double up, double width, double height, const std::string& fill) {
    const double overlap = 0.2;  // else their seams show
    boxes_[fill] +=
        fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h{:.1f}", x(right), y(up + height),
                    width * scale_ + overlap, height * scale_ + overlap, -width * scale_ - overlap);
  }
  [[nodiscard]] std::string done() {
    flush();
    return out_ + "</svg>\n";
  }

 private:
  void flush() {
    for (const auto& [fill, path] : boxes_)
      out_ += fmt::format("<path fill=\"{}\" d=\"{}\"/>\n", fill, path);
    boxes_.clear();
  }

  static constexpr double pixels = 640;
  double left_, top_, scale_;
  std::string out_;
  std::map<std::string, std::string> boxes_;
};

/// Shades in steps, so that runs of one shade are one rectangle: grey inside, blue outside.
std::string shade(double distance, double thickness) {
  constexpr double steps = 12;
  const double part = std::min(1.0, std::abs(distance) / thickness);
  const int step = static_cast<int>(std::min(steps - 1, std::floor(part * steps)));
  if (distance < 0) return fmt::format("#{0:02x}{0:02x}{0:02x}", 120 - 6 * step);
  return fmt::format("#{:02x}{:02x}ff", 130 + 10 * step, 165 + 7 * step);
}

void draw_arrow(Canvas& canvas, double right, double up, double along, double across) {
  const double x = canvas.x(right), y = canvas.y(up), tip_x = canvas.x(right + along),
               tip_y = canvas.y(up + across);
  canvas.raw(fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x, y, tip_x, tip_y));
  const double dx = 0.3 * (tip_x - x), dy = 0.3 * (tip_y - y);
  canvas.raw(fmt::format("l{:.1f} {:.1f}m{:.1f} {:.1f}l{:.1f} {:.1f}", -dx - dy / 2, -dy + dx / 2,
                         dx + dy / 2, dy - dx / 2, -dx + dy / 2, -dy - dx / 2));
}

/// The shadow of a surface as rows of a raster: row -> pairs of first and last filled column.
class Shadow {
 public:
  Shadow(double left, double bottom, double width, double height)
      : left_(left), bottom_(bottom), cell_(std::max(width, height) / raster) {
    columns_ = static_cast<std::size_t>(width / cell_) + 1;
    filled_.resize(columns_ * (static_cast<std::size_t>(height / cell_) + 1));
  }
  void fill(const Surface& surface, const Frame& frame, const View& view) {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      std::array<std::pair<double, double>, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 p = frame.to_world(surface.corners(t)[i]);
        corners[i] = {component(p, view.right), component(p, view.up)};
      }
      fill(corners);
    }
  }
  void fill(std::array<std::pair<double, double>, 3> corners) {
    for (auto& [x, y] : corners) x = (x - left_) / cell_, y = (y - bottom_) / cell_;
    const auto [a, b, c] = corners;
    const auto rows = static_cast<double>(filled_.size() / columns_);
    const double low = std::max(0.0, std::floor(std::min({a.second, b.second, c.second}))),
                 high = std::min(rows - 1, std::max({a.second, b.second, c.second}));
    for (double row = low; row <= high; ++row) {
      double first = HUGE_VAL, last = -HUGE_VAL;
      const auto edge = [&](const auto& from, const auto& to) {
        const double d = to.second - from.second;
        const double t = d == 0 ? 0 : std::clamp((row + 0.5 - from.second) / d, 0.0, 1.0);
        const double x = from.first + t * (to.first - from.first);
        const double y = from.second + t * d;
        if (std::abs(y - row - 0.5) > 0.51) return;
        first = std::min(first, x), last = std::max(last, x);
      };
      edge(a, b), edge(b, c), edge(c, a);
      first = std::max(first, 0.0), last = std::min(last, static_cast<double>(columns_ - 1));
      for (double column = std::floor(first); column <= last; ++column)
        filled_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)] = true;
    }
  }
  void draw(Canvas& canvas) const {
    const std::size_t rows = filled_.size() / columns_;
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t i = 0; i < columns_; ++i) {
        const std::size_t first = i;
        while (i < columns_ && filled_[row * columns_ + i]) ++i;
        if (i == first) continue;
        canvas.box(left_ + cell_ * static_cast<double>(first),
                   bottom_ + cell_ * static_cast<double>(row),
                   cell_ * static_cast<double>(i - first), cell_, "#bbb");
      }
  }
  /// Its edge, not where the window cuts it.
  void outline(Canvas& canvas) const {
    const std::size_t rows = filled_.size() / columns_;
    const auto x = [&](std::size_t i) { return canvas.x(left_ + cell_ * static_cast<double>(i)); };
    const auto y = [&](std::size_t i) {
      return canvas.y(bottom_ + cell_ * static_cast<double>(i));
    };
    canvas.raw("<path fill=\"none\" stroke=\"#888\" stroke-width=\"0.6\" d=\"");
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t i = 0; i < columns_; ++i) {
        const std::size_t at = row * columns_ + i;
        if (i > 0 && filled_[at] != filled_[at - 1])
          canvas.raw(fmt::format("M{:.1f} {:.1f}V{:.1f}", x(i), y(row), y(row + 1)));
        if (row > 0 && filled_[at] != filled_[at - columns_])
          canvas.raw(fmt::format("M{:.1f} {:.1f}H{:.1f}", x(i), y(row), x(i + 1)));
      }
    canvas.raw("\"/>\n");
  }

 private:
  static constexpr double raster = 160;
  double left_, bottom_, cell_;
  std::size_t columns_ = 0;
  std::vector<bool> filled_;
};

}  // namespace

std::string slice_svg(const Field& field, int axis, double at) {
  const View view(axis);
  const Grid& grid = field.grid;
  const auto count = [&](int of) { return grid.n[static_cast<std::size_t>(of)]; };
  const double layer = std::round((at - component(grid.origin, axis)) / grid.cell);
  if (!(layer >= 0 && layer < count(axis)))
    tess::fail(tess::ErrorCode::bad_value, "outputs.slice.at: ", at,
               " is outside of the field, which reaches from ", component(grid.origin, axis),
               " to ", component(grid.origin, axis) + grid.cell * (count(axis) - 1));
  const auto index = [&](int i, int j) {
    std::array<int, 3> voxel{};
    voxel[static_cast<std::size_t>(axis)] = static_cast<int>(layer);
    voxel[static_cast<std::size_t>(view.right)] = i;
    voxel[static_cast<std::size_t>(view.up)] = j;
    return grid.index(voxel[0], voxel[1], voxel[2]);
  };
  const double left = component(grid.origin, view.right) - 0.5 * grid.cell,
               bottom = component(grid.origin, view.up) - 0.5 * grid.cell;
  Canvas canvas(left, bottom, grid.cell * count(view.right), grid.cell * count(view.up));
  for (int j = 0; j < count(view.up); ++j)
    for (int i = 0; i < count(view.right);) {
      const int first = i;
      const std::string fill =
          shade(static_cast<double>(field.distance[index(i, j)]), field.thickness);
      while (i < count(view.right) &&
             shade(static_cast<double>(field.distance[index(i, j)]), field.thickness) == fill)
        ++i;
      canvas.box(left + grid.cell * first, bottom + grid.cell * j, grid.cell * (i - first),
                 grid.cell, fill);
    }
  if (field.normal.empty()) return canvas.done();
  constexpr int arrows = 20;
  const int stride = std::max(1, count(view.right) / arrows);
  canvas.raw("<path fill=\"none\" stroke=\"#000\" stroke-width=\"1\" d=\"");
  for (int j = stride / 2; j < count(view.up); j += stride)
    for (int i = stride / 2; i < count(view.right); i += stride) {
      const Normal n = decode_normal(field.normal[index(i, j)]);
      const Vec3 normal{n.x, n.y, n.z};
      const double length = 0.8 * stride * grid.cell;
      if (normal == Vec3{}) continue;
      draw_arrow(canvas, left + grid.cell * (i + 0.5), bottom + grid.cell * (j + 0.5),
                 length * component(normal, view.right), length * component(normal, view.up));
    }
  canvas.raw("\"/>\n");
  return canvas.done();
}

std::string paths_svg(const Scene& scene, const std::vector<Snapshot>& snapshots) {
  const View view(scene.outputs.axis);
  // The window: the objects and where the particles begin, and as much again around.
  Bounds box;
  for (const SceneObject& object : scene.objects)
    for (const Vec3 p : object.surface.vertices) box.extend(object.frame.to_world(p));
  for (const Sample& sample : snapshots.front().samples) box.extend(sample.position);
  const double left = component(box.low, view.right), bottom = component(box.low, view.up);
  double width = component(box.size(), view.right), height = component(box.size(), view.up);
  const double margin = 0.3 * std::max({width, height, 1e-9});
  width += 2 * margin, height += 2 * margin;
  Canvas canvas(left - margin, bottom - margin, width, height);
  Shadow shadow(left - margin, bottom - margin, width, height), at_end = shadow;
  const double end = snapshots.back().step * scene.dt;
  bool moved = false;
  for (const SceneObject& object : scene.objects) {
    Frame frame = object.frame;
    shadow.fill(object.surface, frame, view);
    if (!frame.is_moving()) continue;
    moved = true;
    frame.advance(end);
    at_end.fill(object.surface, frame, view);
  }
  shadow.draw(canvas);
  if (moved) {
    at_end.outline(canvas);
    canvas.raw(
        fmt::format("<text x=\"8\" y=\"18\" font-family=\"sans-serif\" font-size=\"12\" "
                    "fill=\"#666\">objects at the begin (grey), moving ones at the end, t = {:g} "
                    "(outline)</text>\n",
                    end));
  }
  struct Path {
    std::string drawn;
    bool goes_on = false;  // from where it was last; not after it has left the window
  };
  std::map<std::uint64_t, Path> paths;
  for (const Snapshot& snapshot : snapshots)
    for (const Sample& sample : snapshot.samples) {
      const double right = component(sample.position, view.right) - left + margin,
                   up = component(sample.position, view.up) - bottom + margin;
      Path& path = paths[sample.id];
      const bool seen = right > 0 && right < width && up > 0 && up < height;
      if (seen)
        path.drawn += fmt::format("{}{:.1f} {:.1f}", path.goes_on ? "L" : "M",
                                  canvas.x(right + left - margin), canvas.y(up + bottom - margin));
      path.goes_on = seen;
    }
  canvas.raw("<g fill=\"none\" stroke=\"#04a\" stroke-width=\"0.8\" stroke-opacity=\"0.7\">\n");
  for (const auto& [id, path] : paths)
    if (!path.drawn.empty()) canvas.raw("<path d=\"" + path.drawn + "\"/>\n");
  canvas.raw("</g>\n");
  return canvas.done();
}

}  // namespace particles
