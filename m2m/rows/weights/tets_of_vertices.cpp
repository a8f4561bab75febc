#include "m2m/rows/weights/tets_of_vertices.hpp"

namespace tess::m2m {

TetsOfVertices::TetsOfVertices(std::size_t n_vertices, std::span<const Tet> tets)
    : begin_(n_vertices + 1, 0) {
  for (const Tet& tet : tets)
    for (const VertexId v : tet) ++begin_[static_cast<std::size_t>(v) + 1];
  for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
  tets_.resize(begin_.back());
  std::vector<std::uint64_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t t = 0; t < tets.size(); ++t)
    for (const VertexId v : tets[t])
      tets_[next[static_cast<std::size_t>(v)]++] = static_cast<std::int32_t>(t);
}

}  // namespace tess::m2m
