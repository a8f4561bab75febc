#include "m2m/search/best_donors.hpp"

#include "m2m/search/point_grid.hpp"

namespace tess::m2m {
namespace {

/// Pairs that are located together; they stay in the first cache.
constexpr std::size_t batch = 1024;
/// Up to so many points near a box of the cover, each is compared with each tetrahedron there.
constexpr std::size_t few = 16;

class Search {
 public:
  Search(const MeshView& mesh, std::span<const Point> points)
      : mesh_(mesh), grid_(points), best_(points.size()), donors_(points.size()) {
    pairs_.reserve(2 * batch);
  }

  void visit(const Aabb& around, std::span<const std::uint32_t> tets) {
    near_.clear();
    grid_.visit_in(around, [&](std::int32_t at) { near_.push_back(at); });
    if (near_.empty()) return;
    for (const std::uint32_t t : tets) {
      const auto tet = static_cast<std::int32_t>(t);
      const auto found = [&](std::int32_t at) { pairs_.push_back({tet, at}); };
      const Aabb box = box_of(mesh_.tets[t]);
      if (near_.size() > few) {
        grid_.visit_in(box, found);
      } else {
        for (const std::int32_t at : near_)
          if (grid_.is_in(at, box)) found(at);
      }
      if (pairs_.size() >= batch) locate_batch();
    }
  }

  BestDonors take() {
    locate_batch();
    BestDonors out;
    out.n_tested = n_tested_;
    std::vector<std::uint32_t> position(best_.size());
    for (std::size_t at = 0; at < best_.size(); ++at)
      position[grid_.numbers()[at]] = static_cast<std::uint32_t>(at);
    for (std::size_t point = 0; point < best_.size(); ++point) {
      const std::uint32_t at = position[point];
      if (best_[at].status == Status::outside) continue;
      out.points.push_back(static_cast<std::uint32_t>(point));
      out.candidates.push_back(best_[at]);
      out.donors.push_back(donors_[at]);
    }
    return out;
  }

 private:
  [[nodiscard]] Aabb box_of(const Tet& tet) const {
    Aabb box = collide::box_of(mesh_.points[static_cast<std::size_t>(tet[0])]);
    for (std::size_t corner = 1; corner < 4; ++corner)
      grow(box, mesh_.points[static_cast<std::size_t>(tet[corner])]);
    return padded(box);
  }
  void locate_batch() {
    found_.clear();
    locate_pairs(mesh_.points, mesh_.tets, grid_.points(), pairs_, found_);
    for (const Found& f : found_) {
      const PointPair& pair = pairs_[static_cast<std::size_t>(f.pair)];
      const auto at = static_cast<std::size_t>(pair.point);
      const auto tet = static_cast<std::size_t>(pair.tet);
      const Candidate candidate = candidate_of(f.location, mesh_.tet_ids[tet]);
      if (!better(candidate, best_[at])) continue;
      best_[at] = candidate;
      donors_[at] = {mesh_.tets[tet], f.location.weights};
    }
    n_tested_ += pairs_.size();
    pairs_.clear();
  }

  const MeshView& mesh_;
  PointGrid grid_;
  std::vector<Candidate> best_;  // per position in the grid
  std::vector<Donor> donors_;
  std::vector<std::int32_t> near_;  // positions of the points in the current box of the cover
  std::vector<PointPair> pairs_;
  std::vector<Found> found_;
  std::uint64_t n_tested_ = 0;
};

}  // namespace

BestDonors best_donors(const MeshView& mesh, const Cover& cover,
                       std::span<const std::uint32_t> boxes, std::span<const Point> points) {
  Search search(mesh, points);
  for (const std::uint32_t box : boxes) search.visit(cover.boxes[box], cover.members_of(box));
  return search.take();
}

}  // namespace tess::m2m
