#include "m2m/surface/sides.hpp"

#include "m2m/rows/interpolate/orientation.hpp"

#include <array>

namespace tess::m2m {
namespace {

bool in_order(const std::pair<Tet, Side>& a, const std::pair<Tet, Side>& b) {
  return a.first != b.first             ? a.first < b.first
         : a.second.tet != b.second.tet ? a.second.tet < b.second.tet
                                        : a.second.side < b.second.side;
}

}  // namespace

Tet side_of(const Tet& cell, std::int32_t dimension, std::int32_t side) {
  constexpr std::array<std::array<std::uint8_t, 3>, 4> triangles{
      {{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}}};
  const auto s = static_cast<std::size_t>(side - 1);
  if (dimension == 3) {
    const auto& [a, b, c] = triangles[s];
    return {cell[a], cell[b], cell[c], cell[c]};
  }
  if (dimension == 1) return {cell[s], cell[s], cell[s], cell[s]};
  const VertexId to = cell[(s + 1) % 3];
  return {cell[s], to, to, to};
}

Tet outward(const TetMesh& mesh, const Side& side) {
  const Tet& cell = mesh.tets[static_cast<std::size_t>(side.tet)];
  Tet out = side_of(cell, mesh.dimension, side.side);
  if (mesh.dimension < 3) return out;
  const auto at = [&](VertexId v) { return mesh.points[static_cast<std::size_t>(v)]; };
  const VertexId* opposite = std::ranges::find_if(
      cell, [&](VertexId v) { return std::ranges::find(out, v) == out.end(); });
  if (opposite != cell.end() && orientation(at(*opposite), at(out[0]), at(out[1]), at(out[2])) < 0)
    std::swap(out[0], out[1]);
  return out;
}

Tet key_of(Tet cell, std::int32_t dimension) {
  // By hand: at -O3 g++ 12 takes a std::sort of so few for one that leaves the array.
  const auto n = static_cast<std::size_t>(dimension) + 1;
  for (std::size_t i = 1; i < n; ++i)
    for (std::size_t j = i; j > 0 && cell[j] < cell[j - 1]; --j) std::swap(cell[j], cell[j - 1]);
  std::fill(cell.begin() + dimension + 1, cell.end(), cell[static_cast<std::size_t>(dimension)]);
  return cell;
}

std::vector<Side> boundary_sides(const TetMesh& mesh,
                                 std::span<const std::pair<GlobalId, GlobalId>> cells) {
  std::vector<std::pair<Tet, Side>> all;
  for (const auto& [first, end] : cells)
    for (GlobalId t = first; t < end; ++t) {
      const Tet& cell = mesh.tets[static_cast<std::size_t>(t)];
      if (names_corner_twice(cell, mesh.dimension)) continue;
      for (std::int32_t s = 1; s <= mesh.dimension + 1; ++s)
        all.emplace_back(key_of(side_of(cell, mesh.dimension, s), mesh.dimension - 1), Side{t, s});
    }
  std::sort(all.begin(), all.end(), in_order);
  std::vector<Side> single;
  for (auto at = all.begin(); at != all.end();) {
    const auto end =
        std::find_if(at, all.end(), [&](const auto& e) { return e.first != at->first; });
    if (end - at == 1) single.push_back(at->second);
    at = end;
  }
  std::ranges::sort(single, {}, [](const Side& s) { return std::pair(s.tet, s.side); });
  return single;
}

SideFinder::SideFinder(const TetMesh& mesh, const std::vector<bool>& marks)
    : dimension_(mesh.dimension - 1) {
  for (std::size_t t = 0; t < mesh.n_tets(); ++t)
    for (std::int32_t s = 1; s <= mesh.dimension + 1; ++s) {
      const Tet side = side_of(mesh.tets[t], mesh.dimension, s);
      if (std::ranges::all_of(side, [&](VertexId v) { return marks[static_cast<std::size_t>(v)]; }))
        sorted_.emplace_back(key_of(side, dimension_), Side{static_cast<GlobalId>(t), s});
    }
  std::sort(sorted_.begin(), sorted_.end(), in_order);
}

Side SideFinder::find(const Tet& cell) const {
  const Tet key = key_of(cell, dimension_);
  const auto found = std::ranges::lower_bound(sorted_, key, {}, &std::pair<Tet, Side>::first);
  return found != sorted_.end() && found->first == key ? found->second : Side{-1, 0};
}

}  // namespace tess::m2m
