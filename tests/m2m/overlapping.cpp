#include "tests/m2m/overlapping.hpp"

#include "tests/m2m/cell_grid.hpp"

#include <algorithm>

namespace tess::test {
namespace {

using namespace m2m;

std::vector<Aabb> boxes_of(MeshView mesh) {
  std::vector<Aabb> boxes;
  for (const Tet& tet : mesh.tets) boxes.push_back(search_box(corners_of(mesh.points, tet)));
  return boxes;
}

}  // namespace

std::vector<TetPair> overlapping_pairs(MeshView source, MeshView target) {
  const std::vector<Aabb> boxes = boxes_of(source);
  const CellGrid grid(collide::box_around(source.points), source.tets.size(), boxes);
  std::vector<TetPair> pairs;
  std::vector<std::int32_t> found;
  for (std::size_t t = 0; t < target.tets.size(); ++t) {
    const Aabb box = collide::box_around(corners_of(target.points, target.tets[t]));
    const CellGrid::Cell first = grid.cell_of(box.lo), last = grid.cell_of(box.hi);
    found.clear();
    for (std::int32_t z = first[2]; z <= last[2]; ++z)
      for (std::int32_t y = first[1]; y <= last[1]; ++y)
        for (std::int32_t x = first[0]; x <= last[0]; ++x)
          for (const std::int32_t s : grid.items({x, y, z}))
            if (collide::overlap(boxes[static_cast<std::size_t>(s)], box,
                                 collide::Touching::counts))
              found.push_back(s);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    for (const std::int32_t s : found) pairs.push_back({s, static_cast<std::int32_t>(t)});
  }
  return pairs;
}

std::vector<PointInTet> place_points(MeshView source, std::span<const Point> points) {
  const std::vector<Aabb> boxes = boxes_of(source);
  const CellGrid grid(collide::box_around(source.points), source.tets.size(), boxes);
  std::vector<PointInTet> placed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    Candidate best;
    for (const std::int32_t s : grid.items(grid.cell_of(points[i]))) {
      const auto found =
          locate(points[i], corners_of(source.points, source.tets[static_cast<std::size_t>(s)]));
      if (!found || !better(candidate_of(*found, s), best)) continue;
      best = candidate_of(*found, s);
      placed[i] = {s, found->weights};
    }
  }
  return placed;
}

}  // namespace tess::test
