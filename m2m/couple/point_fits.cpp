#include "m2m/couple/point_fits.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tess::m2m {

double PointFits::add(std::uint32_t point, const NearestVertex::Neighbour& vertex, const Point& at,
                      collide::OwnerId source) {
  const auto first = found_.begin() + static_cast<std::ptrdiff_t>(point * n_wanted());
  std::uint32_t& n = n_found_[point];
  const auto before = [](const Found& a, const NearestVertex::Neighbour& b) {
    return std::tie(a.vertex.squared_distance, a.vertex.id) < std::tie(b.squared_distance, b.id);
  };
  const auto place = std::lower_bound(first, first + n, vertex, before);
  const bool is_known = place != first + n && place->vertex.id == vertex.id;
  if (!is_known && place != first + static_cast<std::ptrdiff_t>(n_wanted())) {
    if (n < n_wanted()) ++n;
    std::move_backward(place, first + n - 1, first + n);
    *place = {vertex, at, source};
  }
  return n < n_wanted() ? std::numeric_limits<double>::infinity()
                        : (first + n - 1)->vertex.squared_distance;
}

Addressed<std::vector<VertexId>> PointFits::finish(std::span<const Point> points,
                                                   TargetFound& found) const {
  MovingLeastSquares fit(order_);
  std::vector<PlaceWeight> rows;
  rows.reserve(points.size() * n_wanted());
  std::vector<Point> neighbours;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::span<const Found> near = std::span(found_).subspan(p * n_wanted(), n_found_[p]);
    found.status.push_back(near.empty() ? Status::outside : Status::inside);
    found.distance.push_back(near.empty() ? std::numeric_limits<double>::infinity()
                                          : std::sqrt(near[0].vertex.squared_distance));
    ++found.tally.counts[static_cast<std::size_t>(found.status.back())];
    if (near.empty()) continue;
    neighbours.clear();
    for (const Found& vertex : near) neighbours.push_back(vertex.at);
    const MovingLeastSquares::Fit got = fit.compute(points[p], neighbours);
    if (got.order < order_)
      ++found.tally.n_lower_order;
    else if (got.dimension < 3)
      ++found.tally.n_lower_dimension;
    for (std::size_t j = 0; j < near.size(); ++j)
      rows.push_back(
          {static_cast<std::uint32_t>(p), near[j].vertex.vertex, near[j].source, fit.weights()[j]});
  }
  return found.given.keep_weights(rows);
}

}  // namespace tess::m2m
