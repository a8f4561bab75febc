// The steps of a survey: what a mesh is like, without its parts.
#include "m2m/mesh/workers/placer.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tess::m2m {

void Placer::mark_used(std::span<const VertexId> vertices) {
  used_.resize(points_.size());
  for (const VertexId v : vertices) {
    const GlobalId at = v - first_point_;
    if (at >= 0 && at < static_cast<GlobalId>(used_.size()))
      used_[static_cast<std::size_t>(at)] = 1;
  }
}

void Placer::finish_survey(Callback<PlacerReport> target) {
  PlacerReport report;
  report.extent = extent_;
  used_.resize(points_.size());
  report.n_unused = static_cast<std::uint64_t>(std::count(used_.begin(), used_.end(), 0));
  for (std::size_t f = 0; f < setup_.fields.size(); ++f) {
    const Formula formula = make_formula(setup_.fields[f].name, setup_.fields[f].domain);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double value = formula(points_[i]);
      if (std::isfinite(value)) continue;
      const GlobalId v = first_point_ + static_cast<GlobalId>(i);
      report.error.keep_first(
          {static_cast<std::int64_t>(f) * setup_.n_points + v,
           static_cast<std::int32_t>(ErrorCode::bad_value),
           not_finite_text(setup_.fields[f].name, value, v, setup_.shown_name, points_[i])});
      break;
    }
  }
  contribute(JoinReports{}, std::move(report), std::move(target));
}

}  // namespace tess::m2m
