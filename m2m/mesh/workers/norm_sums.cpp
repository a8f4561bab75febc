#include "m2m/mesh/workers/norm_sums.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

namespace tess::m2m {
namespace {

constexpr double least_normal = std::numeric_limits<double>::min();

double sum_of(const std::array<double, 4>& x) {
  return (x[0] + x[1]) + (x[2] + x[3]);
}

/// The truth at the points, and the first that is not finite.
std::vector<double> truth_at(std::span<const Point> points, const MeshView& part,
                             const FormulaField& field, std::size_t component, NotFinite& refused) {
  const Formula formula = make_formula(field.name, field.domain);
  std::vector<double> truth;
  truth.reserve(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    truth.push_back(formula(points[v]));
    if (!std::isfinite(truth.back()))
      refused.keep_first(
          {static_cast<std::int64_t>(component), part.point_ids[v], truth.back(), points[v]});
  }
  return truth;
}

/// One component of a part.
struct Component {
  const MeshView& part;
  std::span<const Status> status;
  std::vector<double> values, truth;

  void add_tets(ComponentSums& sums) const {
    const auto n_corners = static_cast<std::size_t>(part.dimension) + 1;
    for (const Tet& tet : part.own_tets()) {
      std::array<Point, 4> corners{};
      std::array<double, 4> e2{}, t2{}, v{}, v2{}, t{}, t1{}, e2_found{}, t2_found{};
      std::size_t n_found = 0;
      for (std::size_t k = 0; k < n_corners; ++k) {
        const auto at = static_cast<std::size_t>(tet[k]);
        corners[k] = part.points[at];
        const double error = values[at] - truth[at];
        e2[k] = error * error;
        t2[k] = truth[at] * truth[at];
        v[k] = values[at];
        v2[k] = values[at] * values[at];
        t[k] = truth[at];
        t1[k] = std::abs(truth[at]);
        if (status[at] == Status::outside) continue;
        ++n_found;
        e2_found[k] = e2[k];
        t2_found[k] = t2[k];
      }
      const double share = measure(corners, part.dimension) / static_cast<double>(n_corners);
      for (std::size_t k = 0; k < n_corners; ++k) {
        const auto at = static_cast<std::size_t>(tet[k]);
        if (share > 0 && ((values[at] != truth[at] && share * e2[k] < least_normal) ||
                          (truth[at] != 0 && share * t2[k] < least_normal)))
          sums.underflows = true;
      }
      SquareSums& whole = n_found == n_corners ? sums.same : sums.all;
      whole.error.add(share * sum_of(e2));
      whole.truth.add(share * sum_of(t2));
      if (n_found > 0 && n_found < n_corners) {
        sums.found.error.add(share * sum_of(e2_found));
        sums.found.truth.add(share * sum_of(t2_found));
      }
      sums.value.add(share * sum_of(v));
      sums.value_squared.add(share * sum_of(v2));
      sums.truth.add(share * sum_of(t));
      sums.truth_magnitude.add(share * sum_of(t1));
    }
  }
  void add_vertices(ComponentSums& sums) const {
    for (std::size_t v = 0; v < part.owned().size(); ++v) {
      const LargestError one{std::abs(values[v] - truth[v]), part.point_ids[v], part.points[v]};
      sums.worst.add(one);
      if (status[v] != Status::outside) sums.worst_found.add(one);
      (status[v] == Status::outside ? sums.plain_outside : sums.plain_found)
          .add(one.error * one.error);
    }
  }
};

}  // namespace

void LargestError::add(const LargestError& other) {
  if (other.vertex < 0) return;
  const auto rank = [](const LargestError& e) {
    return std::tuple(std::isnan(e.error), std::isnan(e.error) ? 0.0 : e.error, -e.vertex);
  };
  if (vertex < 0 || rank(*this) < rank(other)) *this = other;
}

void SquareSums::add(const SquareSums& other) {
  error.add(other.error);
  truth.add(other.truth);
}

void ComponentSums::add(const ComponentSums& other) {
  same.add(other.same);
  all.add(other.all);
  found.add(other.found);
  value.add(other.value);
  value_squared.add(other.value_squared);
  truth.add(other.truth);
  truth_magnitude.add(other.truth_magnitude);
  plain_found.add(other.plain_found);
  plain_outside.add(other.plain_outside);
  worst.add(other.worst);
  worst_found.add(other.worst_found);
  underflows = underflows || other.underflows;
}

void NotFinite::keep_first(const NotFinite& other) {
  if (other.component < 0) return;
  if (component < 0 || std::tuple(other.component, other.vertex) < std::tuple(component, vertex))
    *this = other;
}

NormSums JoinNorms::operator()(NormSums a, const NormSums& b) const {
  for (std::size_t c = 0; c < a.components.size(); ++c) a.components[c].add(b.components[c]);
  a.n_vertices += b.n_vertices;
  a.n_found += b.n_found;
  a.refused.keep_first(b.refused);
  return a;
}

NormSums norm_sums(const MeshView& part, std::span<const double> values,
                   std::span<const Status> status, const NormsRequest& request) {
  NormSums sums;
  sums.components.resize(request.truth.size());
  std::vector<Point> there(part.points.begin(), part.points.end());
  for (const RigidMotion& motion : request.back) move_points(there, motion);
  const std::size_t n = request.truth.size();
  for (std::size_t c = 0; c < n; ++c) {
    Component one{part, status, {}, truth_at(there, part, request.truth[c], c, sums.refused)};
    for (std::size_t v = 0; v < part.points.size(); ++v) one.values.push_back(values[v * n + c]);
    one.add_tets(sums.components[c]);
    one.add_vertices(sums.components[c]);
  }
  sums.n_vertices = part.owned().size();
  for (std::size_t v = 0; v < part.owned().size(); ++v)
    sums.n_found += status[v] != Status::outside ? 1U : 0U;
  return sums;
}

}  // namespace tess::m2m
