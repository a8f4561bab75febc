// What SOURCE or TARGET names: a mesh, or with --source-part and --target-part a part of one.
#pragma once

#include "apps/m2m_transfer/names.hpp"
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

/// `part`: as for surface_of(), or empty. Throws Error with the file or the part that is wrong.
[[nodiscard]] inline ReadPart read_part(const std::string& name, const std::string& part) {
  ReadPart out{read_mesh(name)};
  if (part.empty()) return out;
  out.part = surface_of(out.whole, part);
  return out;
}

}  // namespace m2m_transfer
