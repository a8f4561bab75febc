#include "m2m/search/best_donors.hpp"

#include "m2m/search/box_block.hpp"
#include "m2m/search/point_grid.hpp"

#include <algorithm>
#include <bit>

namespace tess::m2m {
namespace {

/// Pairs that are located together; they stay in the first cache.
constexpr std::size_t batch = 1024;

class Search {
 public:
  Search(const MeshView& mesh, std::span<const Point> points)
      : mesh_(mesh), grid_(points), best_(points.size()), donors_(points.size()) {
    near_.resize(points.size());
    pairs_.resize(batch + BoxBlock::capacity);
  }

  void visit(const Aabb& around, std::span<const std::uint32_t> tets) {
    if (!grid_.any_in(around)) return;
    for (std::size_t first = 0; first < tets.size(); first += BoxBlock::capacity) {
      const auto members = tets.subspan(first, std::min(BoxBlock::capacity, tets.size() - first));
      block_.load(mesh_.points, mesh_.tets, members);
      list_near();
      for (const Near& near : std::span(near_).first(n_near_)) {
        const Point& p = grid_.points()[near.at];
        for (std::uint64_t boxes = near.boxes; boxes != 0; boxes &= boxes - 1) {
          const auto box = static_cast<std::size_t>(std::countr_zero(boxes));
          pairs_[n_pairs_] = {static_cast<std::int32_t>(members[box]),
                              static_cast<std::int32_t>(near.at)};
          n_pairs_ += block_.holds(box, p) ? 1U : 0U;
        }
        if (n_pairs_ >= batch) locate_batch();
      }
    }
  }

  BestDonors take() {
    locate_batch();
    BestDonors out;
    out.n_tested = n_tested_;
    out.points.reserve(best_.size());
    out.candidates.reserve(best_.size());
    out.donors.reserve(best_.size());
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
  /// A point that some boxes of the block may hold, a bit per box.
  struct Near {
    std::uint64_t boxes;
    std::uint32_t at;
  };

  /// Separate from the loop over bits, and without branches: whether a point is near is not
  /// predictable.
  void list_near() {
    n_near_ = 0;
    grid_.visit_rows(block_.around(), [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t at = first; at < last; ++at) {
        const std::uint64_t boxes = block_.maybe_holding(grid_.points()[at]);
        near_[n_near_] = {boxes, at};
        n_near_ += boxes != 0 ? 1U : 0U;
      }
      return true;
    });
  }
  void locate_batch() {
    found_.clear();
    locate_pairs(mesh_.points, mesh_.tets, grid_.points(), std::span(pairs_).first(n_pairs_),
                 found_);
    for (const Found& f : found_) {
      const PointPair& pair = pairs_[static_cast<std::size_t>(f.pair)];
      const auto at = static_cast<std::size_t>(pair.point);
      const auto tet = static_cast<std::size_t>(pair.tet);
      const Candidate candidate = candidate_of(f.location, mesh_.tet_ids[tet]);
      if (!better(candidate, best_[at])) continue;
      best_[at] = candidate;
      donors_[at] = {mesh_.tets[tet], f.location.weights};
    }
    n_tested_ += n_pairs_;
    n_pairs_ = 0;
  }

  const MeshView& mesh_;
  PointGrid grid_;
  std::vector<Candidate> best_;  // per position in the grid
  std::vector<Donor> donors_;
  BoxBlock block_;
  std::vector<Near> near_;  // the first n_near_ are near the block
  std::size_t n_near_ = 0;
  std::vector<PointPair> pairs_;  // the first n_pairs_ wait for their location
  std::size_t n_pairs_ = 0;
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
