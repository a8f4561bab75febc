// Pictures as SVG: the one place that writes its elements. Coordinates are pixels, y points down.
//
//     kit::Canvas canvas({.width = 400, .height = 300});
//     canvas.text({20, 20}, "a title");
//     canvas.path(kit::Path().move({0, 0}).line({9, 0}).line({9, 9}).close(), {.fill = "#bbb"});
//     kit::write_file("a.svg", canvas.svg());
#pragma once

#include "apps/kit/output/chart.hpp"
#include "apps/kit/output/style.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace kit {

/// A red, green and blue of 0 … 255.
using Rgb = std::array<double, 3>;
/// "#rrggbb"; `light` scales the colour.
[[nodiscard]] std::string hex_colour(const Rgb& colour, double light = 1);
/// The colour at `at`, 0 … 1, between stops that are evenly spaced.
[[nodiscard]] Rgb colour_between(std::span<const Rgb> stops, double at);

/// Lines and what they enclose, one decimal each.
class Path {
 public:
  Path& move(Point to) { return append('M', to); }
  Path& line(Point to) { return append('L', to); }
  Path& close();
  /// To the right by so many pixels; by none it is a dot, where the look has round ends.
  Path& right(double by);

  [[nodiscard]] bool empty() const { return commands_.empty(); }
  [[nodiscard]] const std::string& commands() const { return commands_; }

 private:
  Path& append(char command, Point to);
  std::string commands_;
};

/// How something is drawn. An empty text or a negative number is left to the group around it.
struct Look {
  std::string fill{}, stroke{};
  double width = -1;    ///< of the stroke
  double opacity = -1;  ///< of the stroke and the fill
  bool round = false;   ///< ends of lines
  std::string clip{};   ///< a name that clip() has defined
};

enum class Anchor { start, middle, end };

class Canvas {
 public:
  struct Size {
    double width = 0, height = 0;
    double font = font_size;
    double margin = 0;  ///< around the width and height
  };
  /// A white page.
  explicit Canvas(const Size& size);

  Canvas& text(Point at, std::string_view words, Anchor anchor = Anchor::start, double font = 0);
  Canvas& rect(Point corner, double width, double height, const Look& look);
  Canvas& circle(Point centre, double radius, const Look& look);
  /// Nothing for an empty path.
  Canvas& path(const Path& path, const Look& look);
  /// From (left, top) `width` to the right: rectangles of the colours from 0 to 1.
  Canvas& ramp(Point corner, double width, double height, int n, std::span<const Rgb> stops);
  /// What is drawn until end() is moved and has this look where it has none of its own.
  Canvas& begin(Point moved_by = {}, const Look& look = {});
  Canvas& end();
  /// Defines a region for Look::clip.
  Canvas& clip(const std::string& name, Point corner, double width, double height);

  /// The whole file.
  [[nodiscard]] std::string svg() const;

 private:
  Size size_;
  std::string drawn_;
};

}  // namespace kit
