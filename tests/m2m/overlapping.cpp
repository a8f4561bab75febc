#include "tests/m2m/overlapping.hpp"

#include "m2m/rows/weights/native_rows.hpp"
#include "tests/m2m/cell_grid.hpp"

#include <algorithm>
#include <numeric>

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

OverlapRows rows_between(const TetMesh& source, Centring from, const TetMesh& target, Centring to) {
  std::vector<GlobalId> tet_ids(source.n_tets()), point_ids(source.n_points());
  std::iota(tet_ids.begin(), tet_ids.end(), 0);
  std::iota(point_ids.begin(), point_ids.end(), 0);
  const Cover cover = cover_tets(source.points, source.tets);
  TargetTets targets;
  std::vector<double> volumes(to == Centring::nodes ? target.n_points() : target.n_tets(), 0);
  for (std::size_t t = 0; t < target.n_tets(); ++t) {
    targets.tets.push_back(corners_of(target.points, target.tets[t]));
    std::array<std::uint32_t, 4> unknowns;
    for (std::size_t c = 0; c < 4; ++c) {
      unknowns[c] = to == Centring::nodes ? static_cast<std::uint32_t>(target.tets[t][c])
                                          : static_cast<std::uint32_t>(t);
      volumes[unknowns[c]] += signed_volume(target, t);
    }
    targets.unknowns.push_back(unknowns);
  }
  for (const double volume : volumes) targets.quanta.push_back(quantum_of(volume));
  targets.n_rows = static_cast<std::uint32_t>(volumes.size());
  // 50 tetrahedra a box, each near all boxes of the source.
  for (std::size_t first = 0; first < target.n_tets(); first += 50) {
    targets.first.push_back(static_cast<std::uint32_t>(std::min(first + 50, target.n_tets())));
    for (std::uint32_t box = 0; box < cover.boxes.size(); ++box) targets.near.push_back(box);
    targets.first_near.push_back(static_cast<std::uint32_t>(targets.near.size()));
  }
  return overlap_rows({source.points, source.tets, point_ids, tet_ids, 0}, from, cover, targets);
}

std::vector<std::array<double, 4>> covered_by(const OverlapRows& rows, const TetMesh& target) {
  std::vector<std::array<double, 4>> covered(target.n_tets());
  for (std::size_t k = 0; k < rows.tets.size(); ++k) covered[rows.tets[k]] = rows.covered[k];
  return covered;
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

std::vector<double> native_values(const TetMesh& mesh, std::span<const double> values,
                                  std::span<const Point> points, std::uint64_t& n_linear) {
  MeshView whole = view(mesh);
  whole.element_of_tet = mesh.elements.of_tet;
  whole.element_vertices = mesh.elements.vertices;
  const std::vector<PointInTet> places = place_points(whole, points);
  std::vector<double> out;
  n_linear = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Tet& tet = mesh.tets[static_cast<std::size_t>(places[i].tet)];
    const auto location = locate(points[i], corners_of(mesh.points, tet));
    Rows<double> row;
    add_native_row(whole, {points[i], places[i], location->status == Status::snapped}, row,
                   n_linear);
    out.push_back(interpolated(places[i].weights, tet, values.data(), 1));
    if (!row.columns.empty()) apply(row, values, 1, std::span(&out.back(), 1));
  }
  return out;
}

}  // namespace tess::test
