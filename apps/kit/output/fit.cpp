#include "apps/kit/output/fit.hpp"

#include <cmath>

namespace kit {

std::optional<double> fitted_power(const std::vector<Point>& points) {
  std::vector<Point> logs;
  for (const auto& [x, y, low, high] : points)
    if (std::isfinite(x) && std::isfinite(y) && x > 0 && y > 0)
      logs.push_back({std::log(x), std::log(y)});
  Point mean;
  for (const Point& s : logs) {
    mean.x += s.x / static_cast<double>(logs.size());
    mean.y += s.y / static_cast<double>(logs.size());
  }
  double spread = 0, common = 0;
  for (const Point& s : logs) {
    spread += (s.x - mean.x) * (s.x - mean.x);
    common += (s.x - mean.x) * (s.y - mean.y);
  }
  if (logs.size() < 2 || spread < 1e-12) return std::nullopt;
  return common / spread;
}

}  // namespace kit
