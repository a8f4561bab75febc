#include "m2m/rows/search/nearest_cells.hpp"

#include "m2m/rows/search/nearest_vertex.hpp"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

namespace tess::m2m {
namespace {

Aabb box_of_cell(const MeshView& mesh, std::size_t cell) {
  const std::array<Point, 4> corners = corners_of(mesh.points, mesh.tets[cell]);
  Aabb box = collide::box_of(corners[0]);
  for (std::size_t c = 1; c <= static_cast<std::size_t>(mesh.dimension); ++c) grow(box, corners[c]);
  return box;
}

}  // namespace

NearestCells::NearestCells(const MeshView& mesh) {
  const std::size_t n = mesh.own_tets().size();
  const Aabb around = collide::box_around(mesh.points);
  double longest = 0, largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, around.hi[k] - around.lo[k]);
    largest = std::max({largest, -around.lo[k], around.hi[k]});
  }
  most_snap_reach_ = 2 * (snap_edges * longest + snap_ulps * largest);
  const double scale = longest > 0 ? 1 / longest : 0;
  std::vector<collide::BoxTree<Aabb, 3>::Centre> centres;
  centres.reserve(n);
  for (std::size_t cell = 0; cell < n; ++cell) {
    const Aabb box = box_of_cell(mesh, cell);
    auto& centre = centres.emplace_back();
    centre.object = static_cast<std::uint32_t>(cell);
    for (std::size_t k = 0; k < 3; ++k)
      centre.at[k] =
          static_cast<float>(((box.lo[k] - around.lo[k]) + (box.hi[k] - around.lo[k])) * scale);
  }
  tree_ = collide::BoxTree<Aabb, 3>(std::move(centres));
  boxes_.resize(n);
  const auto nodes = tree_.nodes();
  parents_.resize(nodes.size() / 2);
  for (std::size_t at = nodes.size(); at-- > 0;) {
    auto& node = nodes[at];
    node.box = collide::no_box<double, 3>();
    if (node.count == 0) {
      parents_[node.first / 2] = static_cast<std::uint32_t>(at);
      node.box = collide::merged(nodes[node.first].box, nodes[node.first + 1].box);
    }
    tree_.each_place(node, [&](std::uint32_t place) {
      boxes_[place] = box_of_cell(mesh, tree_.object(place));
      node.box = collide::merged(node.box, boxes_[place]);
    });
  }
}

NearestCells::Best NearestCells::find(const MeshView& mesh, const Point& p, Reach reach,
                                      std::uint32_t hint, std::uint64_t& n_tested) const {
  Best best;
  double limit =
      squared_limit(reach.snaps ? std::max(reach.length, most_snap_reach_) : reach.length);
  const auto offer = [&](std::size_t cell, std::uint32_t leaf) {
    const std::array<Point, 4> corners = corners_of(mesh.points, mesh.tets[cell]);
    ++n_tested;
    if (mesh.dimension == 2 && is_beyond(p, corners, limit)) return;
    const Foot foot = foot_of(p, corners, mesh.dimension);
    if (!(foot.distance <= reach.length) && !(reach.snaps && foot.distance <= snap_reach(corners)))
      return;
    const bool is_corner = foot.distance == 0 && std::has_single_bit(foot.feature);
    const Candidate candidate{foot.distance, mesh.tet_ids[cell],
                              foot.distance == 0 ? Status::boundary : Status::snapped,
                              is_corner ? Place::corner : Place::elsewhere};
    if (!better(candidate, best.candidate)) return;
    best = {static_cast<std::int32_t>(cell), leaf, candidate, foot};
    limit = std::min(limit, squared_limit(foot.distance));
  };
  const auto look_below = [&](std::uint32_t node) {
    tree_.descend_near([&](const Aabb& box) { return squared_distance(p, box); }, limit,
                       [&](const auto& leaf) {
                         tree_.each_place(leaf, [&](std::uint32_t place) {
                           if (squared_distance(p, boxes_[place]) <= limit)
                             offer(tree_.object(place), tree_.number_of(leaf));
                         });
                       },
                       node);
  };
  look_below(hint);
  for (std::uint32_t node = hint; node != 0; node = parents_[(node - 1) / 2])
    look_below(node % 2 == 1 ? node + 1 : node - 1);
  return best;
}

template <class ReachOf>
BestDonors NearestCells::find_all(const MeshView& mesh, std::span<const Point> points,
                                  const ReachOf& reach_of, std::uint64_t& n_tested) const {
  BestDonors out;
  std::uint32_t hint = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Best best = find(mesh, points[i], reach_of(i), hint, n_tested);
    if (best.cell < 0) continue;
    hint = best.leaf;
    const Tet& cell = mesh.tets[static_cast<std::size_t>(best.cell)];
    const std::array<Point, 4> corners = corners_of(mesh.points, cell);
    const Location location = location_of(best.foot, points[i], corners, mesh.dimension);
    out.points.push_back(i);
    out.candidates.push_back(candidate_of(location, best.candidate.tet));
    if (mesh.dimension == 2)
      out.candidates.back().side = static_cast<std::int8_t>(side_of(points[i], corners));
    out.donors.push_back({cell, location.weights});
    out.tets.push_back(best.cell);
  }
  return out;
}

BestDonors NearestCells::within(const MeshView& mesh, std::span<const Point> points,
                                std::span<const double> reaches, std::uint64_t& n_tested) const {
  return find_all(
      mesh, points, [&](std::size_t i) { return Reach{reaches[i]}; }, n_tested);
}

BestDonors NearestCells::snapped(const MeshView& mesh, std::span<const Point> points,
                                 double tolerance, std::uint64_t& n_tested) const {
  return find_all(
      mesh, points,
      [&](std::size_t) {
        return Reach{tolerance, true};
      },
      n_tested);
}

}  // namespace tess::m2m
