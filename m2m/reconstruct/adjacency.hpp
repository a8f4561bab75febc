// The tetrahedra around each vertex of a part of a mesh.
#pragma once

#include "m2m/mesh_view.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

class TetsOfVertices {
 public:
  explicit TetsOfVertices(MeshView mesh);
  /// In the order of the mesh. A tetrahedron that names a vertex twice is listed twice.
  [[nodiscard]] std::span<const std::int32_t> operator[](VertexId vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return std::span(tets_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
  }

 private:
  std::vector<std::uint64_t> begin_;
  std::vector<std::int32_t> tets_;
};

/// Collects ids without repeats, in the order in which they come.
class Gather {
 public:
  explicit Gather(std::size_t n_ids) : seen_(n_ids, 0) {}
  /// Starts a new collection.
  void clear() {
    for (const std::int32_t id : found) seen_[static_cast<std::size_t>(id)] = 0;
    found.clear();
  }
  void add(std::int32_t id) {
    std::uint8_t& seen = seen_[static_cast<std::size_t>(id)];
    if (seen == 0) found.push_back(id);
    seen = 1;
  }
  std::vector<std::int32_t> found;

 private:
  std::vector<std::uint8_t> seen_;
};

}  // namespace tess::m2m
