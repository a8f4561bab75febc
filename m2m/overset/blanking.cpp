#include "m2m/overset/blanking.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace tess::m2m {
namespace {

/// Interpolated sums of ones are 1 up to rounding.
constexpr double rounding = 1e-9;

double quality_of(double field_weight) {
  return field_weight > 1 - rounding ? 1 : std::max(field_weight, 0.0);
}

}  // namespace

const char* name_of(Orphan::Reason reason) noexcept {
  constexpr std::array names{"outside", "hole", "least quality"};
  return names[static_cast<std::size_t>(reason)];
}

BlankingReport JoinBlankingReports::operator()(BlankingReport a, const BlankingReport& b) const {
  a.n_field += b.n_field;
  a.n_hole += b.n_hole;
  a.n_fringe += b.n_fringe;
  a.n_orphans += b.n_orphans;
  a.n_full += b.n_full;
  a.least_quality = std::min(a.least_quality, b.least_quality);
  a.orphans.insert(a.orphans.end(), b.orphans.begin(), b.orphans.end());
  std::sort(a.orphans.begin(), a.orphans.end(),
            [](const Orphan& x, const Orphan& y) { return x.point < y.point; });
  if (a.orphans.size() > BlankingReport::most_listed) a.orphans.resize(BlankingReport::most_listed);
  return a;
}

void Blanking::cut(const MeshView& mesh, std::span<const Wall> walls,
                   std::span<const std::uint8_t> on_outer, BlankingOptions options) {
  roles_ = roles_of(mesh, walls, on_outer, options.fringe_layers, options.symmetry);
  options_ = std::move(options);
  flags_.clear();
  for (const Role role : roles_) {
    flags_.push_back(role == Role::hole ? 1 : 0);
    flags_.push_back(role == Role::field ? 1 : 0);
  }
  const auto n_owned = static_cast<std::size_t>(mesh.n_owned);
  offered_.clear();
  reasons_.assign(n_owned, Orphan::Reason::outside);
  iblank_.clear();
  quality_.clear();
  for (std::size_t v = 0; v < n_owned; ++v) {
    const Role role = roles_[v];
    iblank_.push_back(role == Role::hole ? hole : role == Role::field ? field : orphan);
    quality_.push_back(role == Role::field ? 1 : 0);
  }
}

std::span<double> Blanking::offered(CouplingId from) {
  std::vector<double>& offered = offered_[from];
  offered.resize(2 * iblank_.size());
  return offered;
}

void Blanking::settle(const MeshView& mesh, CouplingId from, std::span<const Status> status,
                      std::int32_t mesh_number) {
  TESS_CHECK(mesh_number > 0, "the number of a mesh is at least 1, got ", mesh_number);
  TESS_CHECK(status.size() == iblank_.size() && status.size() == std::size_t(mesh.n_owned),
             "got the status of ", status.size(), " points of a piece that owns ", mesh.n_owned,
             ", and cut() has given roles to ", iblank_.size(),
             ": call cut() before settle(), and again after the piece has changed");
  // There is none if no point has a donor.
  const auto taken = offered_.extract(from);
  for (std::size_t v = 0; v < status.size(); ++v) {
    if (roles_[v] != Role::fringe || status[v] == Status::outside) continue;
    TESS_CHECK(!taken.empty(), "the flags of mesh ", mesh_number,
               " were not taken since cut() and the last settle() of this coupling: apply() it to "
               "offered() before each settle()");
    const std::vector<double>& offered = taken.mapped();
    const double quality = quality_of(offered[2 * v + 1]);
    const bool is_orphan = iblank_[v] == orphan;
    // Corners with the weight 0 give nothing: they may be holes.
    if (offered[2 * v] != 0) {
      if (is_orphan) reasons_[v] = std::max(reasons_[v], Orphan::Reason::hole);
    } else if (quality < options_.least_quality) {
      if (is_orphan) reasons_[v] = Orphan::Reason::least_quality;
    } else if (is_orphan || quality > quality_[v] ||
               (quality == quality_[v] && mesh_number < -iblank_[v])) {
      iblank_[v] = -mesh_number;
      quality_[v] = quality;
    }
  }
}

BlankingReport Blanking::report(const MeshView& mesh) const {
  BlankingReport report;
  for (std::size_t v = 0; v < iblank_.size(); ++v) {
    if (iblank_[v] == hole) {
      ++report.n_hole;
    } else if (iblank_[v] == field) {
      ++report.n_field;
    } else if (iblank_[v] == orphan) {
      ++report.n_orphans;
      report.orphans.push_back({mesh.point_ids[v], mesh.points[v], reasons_[v]});
    } else {
      ++report.n_fringe;
      if (quality_[v] == 1) ++report.n_full;
      report.least_quality = std::min(report.least_quality, quality_[v]);
    }
  }
  return JoinBlankingReports()(std::move(report), {});
}

}  // namespace tess::m2m
