// The tetrahedra around each vertex of a mesh, or of a part of one.
#pragma once

#include "m2m/mesh_view.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

class TetsOfVertices {
 public:
  explicit TetsOfVertices(const MeshView& mesh) : TetsOfVertices(mesh.points.size(), mesh.tets) {}
  TetsOfVertices(std::size_t n_vertices, std::span<const Tet> tets);
  /// In the order of the mesh. A tetrahedron that names a vertex twice is listed twice.
  [[nodiscard]] std::span<const std::int32_t> operator[](VertexId vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return std::span(tets_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
  }

 private:
  std::vector<std::uint64_t> begin_;
  std::vector<std::int32_t> tets_;
};

}  // namespace tess::m2m
