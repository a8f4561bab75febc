// What SOURCE or TARGET names: a mesh, a surface (.obj, .ply or .stl), or with --source-part and
// --target-part a part of one.
#pragma once

#include "apps/m2m_transfer/names.hpp"
#include "collide/read_surface.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/surface.hpp"

#include <optional>
#include <string>

namespace m2m_transfer {

struct ReadPart {
  TetMesh whole{};
  std::optional<SurfaceMesh> part{};  ///< none: all of it

  [[nodiscard]] const TetMesh& mesh() const { return part ? part->mesh : whole; }
};

[[nodiscard]] inline TetMesh read_mesh_or_surface(const std::string& name) {
  if (!tess::dn::names_surface(name)) return read_mesh(name);
  const tess::dn::Surface surface = tess::dn::read_surface(name);
  TetMesh mesh{name, {}, {}};
  mesh.dimension = 2;
  for (const auto& v : surface.vertices) mesh.points.push_back({v.x, v.y, v.z});
  for (const auto& t : surface.triangles) {
    const auto at = [&](std::size_t a) { return static_cast<VertexId>(t[a]); };
    mesh.tets.push_back({at(0), at(1), at(2), at(2)});
  }
  for (const auto& [what, n] : surface.remarks) mesh.skipped.push_back({what, n});
  return mesh;
}

/// `part`: as for surface_of(), or empty. Throws Error with the file or the part that is wrong.
[[nodiscard]] inline ReadPart read_part(const std::string& name, const std::string& part) {
  ReadPart out{read_mesh_or_surface(name)};
  if (part.empty()) return out;
  out.part = surface_of(out.whole, part);
  return out;
}

}  // namespace m2m_transfer
