#include "m2m/rows/reconstruct/element_corners.hpp"

#include "m2m/rows/interpolate/locate.hpp"
#include "m2m/rows/reconstruct/gather.hpp"
#include "m2m/rows/reconstruct/gradient_fit.hpp"
#include "m2m/rows/weights/tets_of_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tess::m2m {
namespace {

/// The elements of a part by ascending id, with their tetrahedra by ascending id: in this order all
/// sums have the same bits in every part.
struct Elements {
  std::vector<std::size_t> tets{};        // sorted
  std::vector<std::size_t> first{};       // per element, in `tets`; and the end
  std::vector<std::int32_t> of_tet{};     // per tetrahedron
  std::vector<Point> centroids{};         // per element
  std::vector<std::uint8_t> is_wanted{};  // the part owns something of it
  [[nodiscard]] std::size_t size() const { return centroids.size(); }
  [[nodiscard]] std::span<const std::size_t> tets_of(std::size_t e) const {
    return std::span(tets).subspan(first[e], first[e + 1] - first[e]);
  }
};

/// The mean over the volume or area; of the cells if they have none.
Point centroid_of(const MeshView& mesh, std::span<const std::size_t> tets) {
  const Point origin = mesh.points[static_cast<std::size_t>(mesh.tets[tets.front()][0])];
  double largest = 0;
  for (const std::size_t t : tets)
    for (const Point& p : corners_of(mesh.points, mesh.tets[t]))
      for (const double x : difference(p, origin)) largest = std::max(largest, std::abs(x));
  // In units of a power of two: a volume times a length may leave the range of double.
  int exponent = 0;
  (void)std::frexp(largest, &exponent);
  Point sum{}, plain{};
  double volume = 0;
  for (const std::size_t t : tets) {
    std::array<Point, 4> corners = corners_of(mesh.points, mesh.tets[t]);
    for (Point& p : corners) p = difference(p, origin);
    const double v = measure(corners, mesh.dimension);
    const Point mean = mean_of_corners(corners, mesh.dimension);
    volume += v;
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += v * std::ldexp(mean[k], -exponent);
      plain[k] += mean[k] / static_cast<double>(tets.size());
    }
  }
  Point out;
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = origin[k] + (volume > 0 ? std::ldexp(sum[k] / volume, exponent) : plain[k]);
  return out;
}

Elements elements_of(const MeshView& mesh, std::span<const GlobalId> ids) {
  Elements out;
  out.tets.resize(mesh.tets.size());
  std::iota(out.tets.begin(), out.tets.end(), std::size_t{0});
  std::sort(out.tets.begin(), out.tets.end(), [&](std::size_t a, std::size_t b) {
    return ids[a] != ids[b] ? ids[a] < ids[b] : mesh.tet_ids[a] < mesh.tet_ids[b];
  });
  out.of_tet.resize(mesh.tets.size());
  const std::size_t n_own = mesh.own_tets().size();
  for (std::size_t i = 0; i < out.tets.size(); ++i) {
    const std::size_t t = out.tets[i];
    if (i == 0 || ids[t] != ids[out.tets[i - 1]]) {
      out.first.push_back(i);
      out.is_wanted.push_back(0);
    }
    out.of_tet[t] = static_cast<std::int32_t>(out.first.size() - 1);
    if (t < n_own) out.is_wanted.back() = 1;
  }
  out.first.push_back(out.tets.size());
  for (std::size_t e = 0; e + 1 < out.first.size(); ++e)
    out.centroids.push_back(centroid_of(mesh, out.tets_of(e)));
  return out;
}

/// How far along its gradient an element may go: 1, or less.
double limited(double own, const Point& gradient, double low, double high,
               std::span<const Point> arms) {
  double factor = 1;
  for (const Point& arm : arms) {
    const double change = dot(gradient, arm);
    if (change > 0) factor = std::min(factor, (high - own) / change);
    if (change < 0) factor = std::min(factor, (low - own) / change);
  }
  return std::max(factor, 0.0);
}

}  // namespace

std::vector<double> element_corners(MeshView mesh, std::span<const GlobalId> ids,
                                    std::span<const double> values, std::size_t n_components,
                                    CornerLimit limit) {
  const Elements elements = elements_of(mesh, ids);
  const TetsOfVertices around(mesh);
  std::vector<double> out(4 * mesh.tets.size() * n_components, 0.0);
  Gather patch(elements.size());
  GradientFit fit;
  std::vector<Point> offsets, arms;
  const auto value = [&](std::int32_t e, std::size_t c) {
    return values[elements.tets[elements.first[static_cast<std::size_t>(e)]] * n_components + c];
  };
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (elements.is_wanted[e] == 0) continue;
    const auto me = static_cast<std::int32_t>(e);
    patch.clear();
    patch.add(me);
    arms.clear();
    for (const std::size_t t : elements.tets_of(e))
      for (const VertexId v : mesh.tets[t]) {
        arms.push_back(difference(mesh.points[static_cast<std::size_t>(v)], elements.centroids[e]));
        for (const std::int32_t near : around[v])
          patch.add(elements.of_tet[static_cast<std::size_t>(near)]);
      }
    const auto neighbours = std::span(patch.found).subspan(1);
    std::sort(neighbours.begin(), neighbours.end());
    offsets.clear();
    for (const std::int32_t n : neighbours)
      offsets.push_back(
          difference(elements.centroids[static_cast<std::size_t>(n)], elements.centroids[e]));
    fit.compute(offsets, FitDegree::linear, rounding_at(elements.centroids[e]), arms);
    for (std::size_t c = 0; c < n_components; ++c) {
      const double own = value(me, c);
      double low = own, high = own;
      Point gradient{};
      for (std::size_t n = 0; n < neighbours.size(); ++n) {
        const double other = value(neighbours[n], c);
        low = std::min(low, other);
        high = std::max(high, other);
        for (std::size_t k = 0; k < 3; ++k) gradient[k] += fit.weights()[n][k] * (other - own);
      }
      const double factor =
          limit == CornerLimit::neighbours ? limited(own, gradient, low, high, arms) : 1;
      std::size_t arm = 0;
      for (const std::size_t t : elements.tets_of(e))
        for (std::size_t corner = 0; corner < 4; ++corner, ++arm)
          out[(4 * t + corner) * n_components + c] = own + factor * dot(gradient, arms[arm]);
    }
  }
  return out;
}

}  // namespace tess::m2m
