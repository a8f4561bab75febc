#include "m2m/rows/search/best_donors.hpp"

#include "m2m/rows/interpolate/nearest_point.hpp"
#include "m2m/rows/search/near_pairs.hpp"

namespace tess::m2m {
namespace {

/// Pairs that are located together; they stay in the first cache.
constexpr std::size_t batch = 1024;

struct Best {
  std::vector<Candidate> candidates{};  // per point
  std::vector<Donor> donors{};
  std::vector<std::int32_t> tets{};

  explicit Best(std::size_t n) : candidates(n), donors(n), tets(n) {}
  void offer(std::size_t point, const Candidate& candidate, std::span<const Tet> all,
             std::size_t tet, const Weights& weights) {
    if (!better(candidate, candidates[point])) return;
    candidates[point] = candidate;
    donors[point] = {all[tet], weights};
    tets[point] = static_cast<std::int32_t>(tet);
  }
};

/// Finds the best of the tetrahedra that hold a point, or that it snaps to. The points are in the
/// order of the pairs' grid.
class DonorSearch {
 public:
  DonorSearch(const MeshView& mesh, std::span<const Point> points)
      : mesh_(mesh), pairs_(mesh, points, 0), best_(points.size()) {}

  void visit(const Aabb& around, std::span<const std::uint32_t> tets) {
    pairs_.visit(around, tets, [&](std::uint32_t tet, std::uint32_t at, bool holds) {
      waiting_[n_waiting_] = {static_cast<std::int32_t>(tet), static_cast<std::int32_t>(at)};
      n_waiting_ += holds ? 1U : 0U;
      if (n_waiting_ == batch) locate();
    });
  }
  Best take(std::uint64_t& n_tested) {
    locate();
    n_tested = n_tested_;
    return std::move(best_);
  }
  [[nodiscard]] const PointGrid& grid() const { return pairs_.grid(); }

 private:
  void locate() {
    found_.clear();
    locate_pairs(mesh_.points, mesh_.tets, grid().points(), std::span(waiting_).first(n_waiting_),
                 found_);
    for (const Found& f : found_) {
      const PointPair& pair = waiting_[static_cast<std::size_t>(f.pair)];
      const auto tet = static_cast<std::size_t>(pair.tet);
      best_.offer(static_cast<std::size_t>(pair.point),
                  candidate_of(f.location, mesh_.tet_ids[tet]), mesh_.tets, tet,
                  f.location.weights);
    }
    n_tested_ += n_waiting_;
    n_waiting_ = 0;
  }

  const MeshView& mesh_;
  NearPairs pairs_;
  Best best_;
  std::vector<PointPair> waiting_ = std::vector<PointPair>(batch);
  std::size_t n_waiting_ = 0;
  std::vector<Found> found_;
  std::uint64_t n_tested_ = 0;
};

/// Snaps the points that no tetrahedron holds to the nearest one within the tolerance. Those that
/// are within rounding of one are among them: another piece of the mesh may hold one that is
/// nearer.
void snap(const MeshView& mesh, const Cover& cover, std::span<const std::uint32_t> boxes,
          std::span<const Point> points, double tolerance, Best& best) {
  std::vector<std::uint32_t> outside;
  std::vector<Point> left;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (best.candidates[i].status >= Status::snapped) {
      outside.push_back(i);
      left.push_back(points[i]);
    }
  if (left.empty()) return;
  NearPairs pairs(mesh, left, tolerance);
  for (const std::uint32_t box : boxes)
    pairs.visit(cover.boxes[box], cover.members_of(box),
                [&](std::uint32_t tet, std::uint32_t at, bool holds) {
                  if (!holds) return;
                  const NearestPoint near = nearest_point(pairs.grid().points()[at],
                                                          corners_of(mesh.points, mesh.tets[tet]));
                  if (near.distance > tolerance) return;
                  best.offer(outside[pairs.grid().numbers()[at]],
                             {near.distance, mesh.tet_ids[tet], Status::snapped}, mesh.tets, tet,
                             near.weights);
                });
}

}  // namespace

std::vector<BestDonors> best_donors(const MeshView& mesh, const Cover& cover,
                                    std::span<const std::uint32_t> boxes,
                                    std::span<const std::span<const Point>> lists, double tolerance,
                                    std::uint64_t& n_tested) {
  std::vector<Point> points;
  for (const std::span<const Point> list : lists)
    points.insert(points.end(), list.begin(), list.end());
  DonorSearch search(mesh, points);
  for (const std::uint32_t box : boxes) search.visit(cover.boxes[box], cover.members_of(box));
  Best best = search.take(n_tested);
  if (tolerance > 0) snap(mesh, cover, boxes, search.grid().points(), tolerance, best);

  std::vector<std::uint32_t> position(points.size());
  for (std::size_t at = 0; at < points.size(); ++at)
    position[search.grid().numbers()[at]] = static_cast<std::uint32_t>(at);
  std::vector<BestDonors> out;
  std::size_t point = 0;
  for (const std::span<const Point> list : lists) {
    BestDonors& of_list = out.emplace_back();
    of_list.points.reserve(list.size());
    of_list.candidates.reserve(list.size());
    of_list.donors.reserve(list.size());
    of_list.tets.reserve(list.size());
    for (std::uint32_t i = 0; i < list.size(); ++i) {
      const std::uint32_t at = position[point++];
      if (best.candidates[at].status == Status::outside) continue;
      of_list.points.push_back(i);
      of_list.candidates.push_back(best.candidates[at]);
      of_list.donors.push_back(best.donors[at]);
      of_list.tets.push_back(best.tets[at]);
    }
  }
  return out;
}

}  // namespace tess::m2m
