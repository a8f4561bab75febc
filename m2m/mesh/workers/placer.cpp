#include "m2m/mesh/workers/placer.hpp"

#include "m2m/io/ranges/mesh_ranges.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <utility>

namespace tess::m2m {

Placer::Placer(const PlacerSetup& setup)
    : setup_(setup), n_pes_(tess::n_pes()), me_(tess::my_pe().value) {
  first_point_ = first_of(setup.n_points, me_);
  first_tet_ = first_of(setup.n_tets, me_);
  first_part_ = first_part_of(me_);
  parts_.resize(static_cast<std::size_t>(first_part_of(me_ + 1) - first_part_));
  const GlobalId end = first_unused_of(first_part_of(me_ + 1));
  for (GlobalId v = first_unused_of(first_part_); v < end; ++n_unused_due_)
    v = first_of(setup.n_points, keeper_of(v) + 1);
}

PeId Placer::home_of(std::int32_t part) const {
  return PeId{static_cast<std::int32_t>(std::int64_t{part} * n_pes_ / setup_.n_parts)};
}

void Placer::read(RangeLoad load, Callback<PlacerReport> target) {
  points_ = std::move(load.points);
  tets_ = std::move(load.tets);
  PlacerReport report;
  const GlobalId n_points = first_of(setup_.n_points, me_ + 1) - first_point_;
  const GlobalId n_tets = first_of(setup_.n_tets, me_ + 1) - first_tet_;
  try {
    if (!setup_.name.empty()) {
      const std::unique_ptr<MeshRanges> file = open_ranges(setup_.name);
      if (file == nullptr || file->n_points != setup_.n_points || file->n_tets != setup_.n_tets)
        fail(ErrorCode::bad_file, setup_.name, ": differs between the processes on ", tess::my_pe(),
             "; give a file that all processes see");
      points_.resize(static_cast<std::size_t>(n_points));
      file->points(first_point_, points_);
      tets_.resize(static_cast<std::size_t>(n_tets));
      file->tets(first_tet_, tets_);
    }
    report.findings.dimension = setup_.dimension;
    report.findings.add_points(first_point_, points_);
    report.findings.add_corners(first_tet_, tets_, setup_.n_points);
  } catch (const Error& error) {
    report.error = {me_, static_cast<std::int32_t>(error.code()), error.what()};
  }
  const bool refused = report.error.key >= 0 || report.findings.bad_corner.tet >= 0 ||
                       report.findings.bad_cell.tet >= 0;
  knows_ = refused ? Knows::refused : Knows::points;
  if (!refused) ask_corners();
  for (PointQuery& query : std::exchange(queries_, {})) receive_query(std::move(query));
  contribute(JoinReports{}, std::move(report), std::move(target));
}

void Placer::ask_corners() {
  if (setup_.is_survey)
    for (const Tet& tet : tets_) mark_used(tet);
  const auto begin = static_cast<VertexId>(first_point_);
  const auto end = static_cast<VertexId>(first_point_ + static_cast<GlobalId>(points_.size()));
  VertexId least = end, greatest = begin - 1;
  for (const Tet& tet : tets_)
    for (const VertexId v : tet) {
      least = std::min(least, v);
      greatest = std::max(greatest, v);
    }
  if (least >= begin && greatest < end) return;
  far_.emplace(least, greatest);
  for (const Tet& tet : tets_)
    for (const VertexId v : tet)
      if (v < begin || v >= end) far_->add(v);
  far_->number();
  const std::vector<VertexId> ids = far_->list();
  far_points_.resize(ids.size());
  for_each_keeper(ids, [&](std::int32_t keeper, std::span<const VertexId> of) {
    send_query({tess::my_pe(),
                PeId{keeper},
                {},
                {static_cast<std::int32_t>(of.size())},
                {of.begin(), of.end()}});
  });
}

std::array<Point, 4> Placer::corners_of(const Tet& tet) const {
  std::array<Point, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) {
    const GlobalId at = tet[k] - first_point_;
    corners[k] = at >= 0 && at < static_cast<GlobalId>(points_.size())
                     ? points_[static_cast<std::size_t>(at)]
                     : far_points_[static_cast<std::size_t>(far_->rank(tet[k]))];
  }
  return corners;
}

void Placer::measure(const Aabb& bounds, Callback<PlacerReport> target) {
  measures_ = bounds;
  measured_ = std::move(target);
  measure_if_complete();
}

void Placer::measure_if_complete() {
  if (!measures_ || n_answers_due_ != 0) return;
  PlacerReport report;
  report.findings.dimension = setup_.dimension;
  const HilbertCube cube(*measures_);
  measures_.reset();
  cells_.resize(tets_.size());
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    const std::array<Point, 4> corners = corners_of(tets_[t]);
    report.findings.add_shape(first_tet_ + static_cast<GlobalId>(t), corners);
    if (setup_.is_survey) extent_.add(corners, setup_.dimension);
    cells_[t] = cube.cell(mean_of_corners(corners));
  }
  far_.reset();
  drop(far_points_);
  report.counts =
      CurveCut(static_cast<std::uint64_t>(setup_.n_tets), setup_.n_parts).counts(cells_);
  contribute(JoinReports{}, std::move(report), std::move(measured_));
}

void Placer::count(const CurveCut& cut, Callback<PlacerReport> target) {
  PlacerReport report;
  report.counts = cut.counts(cells_);
  contribute(JoinReports{}, std::move(report), std::move(target));
}

void Placer::send_tets(const CurveCut& cut) {
  n_tets_due_ = cut.n_tets_of(first_part_, first_part_ + static_cast<std::int32_t>(parts_.size()));
  const std::vector<std::int32_t> parts = cut.parts(cells_);
  drop(cells_);
  std::vector<std::uint32_t> begin(static_cast<std::size_t>(setup_.n_parts) + 1);
  for (const std::int32_t part : parts) ++begin[static_cast<std::size_t>(part) + 1];
  std::vector<TetBatch> batches;  // in the order of the parts
  for (std::int32_t k = 0; k < setup_.n_parts; ++k) {
    const std::uint32_t n = begin[static_cast<std::size_t>(k) + 1];
    begin[static_cast<std::size_t>(k) + 1] += begin[static_cast<std::size_t>(k)];
    if (n == 0) continue;
    const PeId to = home_of(k);
    if (batches.empty() || batches.back().to != to) batches.push_back({tess::my_pe(), to});
    batches.back().parts.push_back(k);
    batches.back().sizes.push_back(static_cast<std::int32_t>(n));
  }
  std::vector<std::int32_t> order(tets_.size());
  for (std::size_t t = 0; t < parts.size(); ++t)
    order[begin[static_cast<std::size_t>(parts[t])]++] = static_cast<std::int32_t>(t);
  auto next = order.begin();
  for (TetBatch& batch : batches) {
    std::int64_t n = 0;
    for (const std::int32_t size : batch.sizes) n += size;
    batch.ids.reserve(static_cast<std::size_t>(n));
    batch.tets.reserve(static_cast<std::size_t>(n));
    for (const auto end = next + n; next != end; ++next) {
      batch.ids.push_back(static_cast<std::int32_t>(first_tet_ + *next));
      batch.tets.push_back(tets_[static_cast<std::size_t>(*next)]);
    }
    group()[batch.to].send<&Placer::receive_tets>(std::move(batch));
  }
  drop(tets_);
  ask_points_if_complete();
}

void Placer::receive_tets(TetBatch batch) {
  n_tets_here_ += batch.tets.size();
  batches_.push_back(std::move(batch));
  ask_points_if_complete();
}

void Placer::ask_points_if_complete() {
  if (n_tets_due_ != n_tets_here_) return;
  n_tets_due_.reset();
  make_drafts();
  ask_points_of_parts();
}

}  // namespace tess::m2m
