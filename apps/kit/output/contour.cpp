#include "apps/kit/output/contour.hpp"

#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace kit {
namespace {

/// Twice the coordinates of a place: those of a grid edge's middle name the edge.
using Place = std::pair<int, int>;

}  // namespace

std::vector<std::vector<Point>> contours(int n_columns, int n_rows,
                                         const std::function<double(int column, int row)>& value,
                                         double level) {
  const auto at = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < n_columns && j < n_rows ? value(i, j) : HUGE_VAL;
  };
  std::map<Place, Place> next;  // along a line, from edge to edge
  for (int j = -1; j < n_rows; ++j)
    for (int i = -1; i < n_columns; ++i) {
      constexpr std::array<Place, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
      std::array<bool, 4> below{};
      for (std::size_t k = 0; k < 4; ++k)
        below[k] = at(i + corners[k].first, j + corners[k].second) < level;
      const auto edge = [&](std::size_t k) {
        const Place a = corners[k], b = corners[(k + 1) % 4];
        return Place{2 * i + a.first + b.first, 2 * j + a.second + b.second};
      };
      // A line enters the square where the region ends, going around it, and leaves where the
      // region began before that.
      for (std::size_t k = 0; k < 4; ++k) {
        if (!below[k] || below[(k + 1) % 4]) continue;
        std::size_t began = k;
        while (below[began]) began = (began + 3) % 4;
        next[edge(k)] = edge(began);
      }
    }
  const auto point = [&](Place edge) {
    const auto [x, y] = edge;
    const int dx = std::abs(x % 2), dy = std::abs(y % 2);
    const int i = (x - dx) / 2, j = (y - dy) / 2;
    const double from = at(i, j), to = at(i + dx, j + dy);
    double part = (level - from) / (to - from);
    if (!std::isfinite(from)) part = 1;
    if (!std::isfinite(to)) part = 0;
    return Point{i + part * dx, j + part * dy};
  };
  std::vector<std::vector<Point>> lines;
  while (!next.empty()) {
    std::vector<Point>& line = lines.emplace_back();
    for (auto now = next.begin(); now != next.end();) {
      line.push_back(point(now->first));
      const Place to = now->second;
      next.erase(now);
      now = next.find(to);
    }
  }
  return lines;
}

}  // namespace kit
