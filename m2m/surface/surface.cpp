#include "m2m/surface.hpp"

#include "m2m/surface/sides.hpp"
#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

namespace tess::m2m {
namespace {

using CellSpan = std::pair<GlobalId, GlobalId>;

/// The sides, each once.
std::vector<Side> without_repeats(const TetMesh& mesh, const std::vector<Side>& sides) {
  std::vector<std::pair<Tet, std::size_t>> keys;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Tet& cell = mesh.tets[static_cast<std::size_t>(sides[i].tet)];
    keys.emplace_back(key_of(side_of(cell, mesh.dimension, sides[i].side), mesh.dimension - 1), i);
  }
  std::ranges::sort(keys);
  std::vector<bool> repeats(sides.size());
  for (std::size_t k = 1; k < keys.size(); ++k)
    repeats[keys[k].second] = keys[k].first == keys[k - 1].first;
  std::vector<Side> out;
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (!repeats[i]) out.push_back(sides[i]);
  return out;
}

/// Collects cells; number() then gives them points of their own.
struct Collected {
  const TetMesh& volume;
  SurfaceMesh out{};

  void add_sides(const std::vector<Side>& sides) {
    out.mesh.dimension = volume.dimension - 1;
    for (const Side& side : sides) {
      out.mesh.tets.push_back(outward(volume, side));
      out.tet_of_cell.push_back(side.tet);
    }
  }
  void add_cells(const CellSpan& range) {
    out.mesh.dimension = volume.dimension;
    for (GlobalId t = range.first; t < range.second; ++t) {
      out.mesh.tets.push_back(volume.tets[static_cast<std::size_t>(t)]);
      out.tet_of_cell.push_back(t);
    }
  }
  SurfaceMesh number(std::string_view part, std::int64_t id, const std::string& name) {
    if (out.mesh.tets.empty())
      fail(ErrorCode::bad_argument, "mesh ", volume.name, ": its part '", part,
           "' is empty; name another part, or none");
    std::vector<VertexId> point_of(volume.n_points(), -1);
    for (const Tet& cell : out.mesh.tets)
      for (const VertexId v : cell) point_of[static_cast<std::size_t>(v)] = 0;
    for (std::size_t v = 0; v < point_of.size(); ++v) {
      if (point_of[v] < 0) continue;
      point_of[v] = static_cast<VertexId>(out.vertex_of_point.size());
      out.vertex_of_point.push_back(static_cast<VertexId>(v));
      out.mesh.points.push_back(volume.points[v]);
    }
    for (Tet& cell : out.mesh.tets)
      for (VertexId& v : cell) v = point_of[static_cast<std::size_t>(v)];
    out.mesh.name = text(volume.name, ":", part);
    out.mesh.blocks = {{id, name, out.mesh.n_tets()}};
    return std::move(out);
  }
};

/// Calls f(block, its cells) for each block.
template <class F>
void for_blocks(const TetMesh& mesh, const F& f) {
  GlobalId first = 0;
  for (const Block& block : mesh.blocks) {
    const GlobalId end = first + static_cast<GlobalId>(block.n_tets);
    f(block, CellSpan{first, end});
    first = end;
  }
}

std::string known_parts(const TetMesh& mesh) {
  std::string out;
  const auto add = [&out](const std::string& name) { out += (out.empty() ? "" : ", ") + name; };
  for (const SideSet& set : mesh.side_sets)
    add(set.name.empty() ? std::to_string(set.id) : set.name);
  if (!mesh.side_sets.empty()) out += mesh.side_sets.size() == 1 ? " (side set)" : " (side sets)";
  for (const Block& block : mesh.blocks)
    add(text("block ", block.id) + (block.name.empty() ? "" : " '" + block.name + "'"));
  if (mesh.dimension > 1) add("skin");
  return out.empty() ? "none" : out;
}

/// The part whose sets or blocks fit; empty if there are none.
template <class Fits>
std::optional<SurfaceMesh> side_sets(const TetMesh& mesh, std::string_view part, const Fits& fits) {
  std::vector<Side> sides;
  const SideSet* first = nullptr;
  for (const SideSet& set : mesh.side_sets) {
    if (mesh.dimension == 1 || !fits(set.id, set.name)) continue;
    if (first == nullptr) first = &set;
    sides.insert(sides.end(), set.entries.begin(), set.entries.end());
  }
  if (first == nullptr) return std::nullopt;
  Collected all{mesh};
  all.add_sides(without_repeats(mesh, sides));
  return all.number(part, first->id, first->name);
}
template <class Fits>
std::optional<SurfaceMesh> blocks(const TetMesh& mesh, std::string_view part, const Fits& fits) {
  std::vector<CellSpan> ranges;
  const Block* first = nullptr;
  for_blocks(mesh, [&](const Block& block, const CellSpan& range) {
    if (!fits(block.id, block.name)) return;
    if (first == nullptr) first = &block;
    ranges.push_back(range);
  });
  if (first == nullptr) return std::nullopt;
  Collected all{mesh};
  if (mesh.dimension == 3) all.add_sides(boundary_sides(mesh, ranges));
  if (mesh.dimension < 3)
    for (const CellSpan& range : ranges) all.add_cells(range);
  return all.number(part, first->id, first->name);
}

}  // namespace

SurfaceMesh skin_of(const TetMesh& mesh) {
  if (mesh.dimension == 1)
    fail(ErrorCode::bad_argument, "mesh ", mesh.name,
         ": a mesh of edges has no skin; name a block, or none");
  Collected all{mesh};
  all.add_sides(
      boundary_sides(mesh, std::array{CellSpan{0, static_cast<GlobalId>(mesh.n_tets())}}));
  return all.number("skin", 1, "skin");
}

SurfaceMesh surface_of(const TetMesh& mesh, std::string_view part) {
  if (part == "skin") return skin_of(mesh);
  const auto named = [part](std::int64_t, const std::string& name) {
    return !name.empty() && name == part;
  };
  if (auto found = side_sets(mesh, part, named)) return std::move(*found);
  if (auto found = blocks(mesh, part, named)) return std::move(*found);
  const bool is_block = part.starts_with("block ");
  const auto number = parse_number<std::int64_t>(is_block ? part.substr(6) : part);
  const auto numbered = [number](std::int64_t id, const std::string&) { return id == number; };
  if (number && !is_block)
    if (auto found = side_sets(mesh, part, numbered)) return std::move(*found);
  if (number)
    if (auto found = blocks(mesh, part, numbered)) return std::move(*found);
  fail(ErrorCode::bad_argument, "mesh ", mesh.name, " has no part '", part, "': there are ",
       known_parts(mesh), did_you_mean(part, known_parts(mesh)));
}

}  // namespace tess::m2m
