#include "m2m/elements/split_element.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <array>

namespace tess::m2m {
namespace {

using Face = std::array<std::int8_t, 6>;  // vertices of an element, -1 from the last one on

/// The sides of ExodusII, counter-clockwise seen from outside.
struct Shape {
  std::size_t n_vertices;
  std::vector<Face> sides;
};

const Shape& shape_of(ElementType type) {
  static const std::array<Shape, 5> shapes{{
      {4,
       {{0, 1, 3, -1, -1, -1},
        {1, 2, 3, -1, -1, -1},
        {0, 3, 2, -1, -1, -1},
        {0, 2, 1, -1, -1, -1}}},
      {8,
       {{0, 1, 5, 4, -1, -1},
        {1, 2, 6, 5, -1, -1},
        {2, 3, 7, 6, -1, -1},
        {0, 4, 7, 3, -1, -1},
        {0, 3, 2, 1, -1, -1},
        {4, 5, 6, 7, -1, -1}}},
      {6,
       {{0, 1, 4, 3, -1, -1},
        {1, 2, 5, 4, -1, -1},
        {0, 3, 5, 2, -1, -1},
        {0, 2, 1, -1, -1, -1},
        {3, 4, 5, -1, -1, -1}}},
      {5,
       {{0, 1, 4, -1, -1, -1},
        {1, 2, 4, -1, -1, -1},
        {2, 3, 4, -1, -1, -1},
        {0, 4, 3, -1, -1, -1},
        {0, 3, 2, 1, -1, -1}}},
      {10, {{0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 2, 1, 6, 5, 4}}},
  }};
  return shapes[static_cast<std::size_t>(type)];
}

void append(const Tet& tet, std::vector<Tet>& tets) {
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b)
      if (tet[a] == tet[b]) return;
  tets.push_back(tet);
}

/// Corners first; of the octahedron, those around its diagonal from the edge 0 2 to the edge 1 3.
void split_tet10(std::span<const VertexId> v, std::vector<Tet>& tets) {
  constexpr std::size_t parts[8][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3},
                                       {4, 6, 7, 8}, {4, 5, 6, 8}, {6, 7, 8, 9}, {5, 9, 6, 8}};
  for (const auto& part : parts) append({v[part[0]], v[part[1]], v[part[2]], v[part[3]]}, tets);
}

}  // namespace

std::size_t n_vertices(ElementType type) noexcept {
  return shape_of(type).n_vertices;
}
std::size_t n_sides(ElementType type) noexcept {
  return shape_of(type).sides.size();
}

void split_element(ElementType type, std::span<const VertexId> vertices, std::vector<Tet>& tets) {
  const Shape& shape = shape_of(type);
  TESS_CHECK(vertices.size() == shape.n_vertices, "expected ", shape.n_vertices, " vertices, got ",
             vertices.size());
  if (type == ElementType::tet10) return split_tet10(vertices, tets);
  if (type == ElementType::tet4)
    return tets.push_back({vertices[0], vertices[1], vertices[2], vertices[3]});
  const VertexId apex = *std::min_element(vertices.begin(), vertices.end());
  for (const Face& side : shape.sides) {
    std::array<VertexId, 4> face{};
    std::size_t n = 0;
    for (; n < 4 && side[n] >= 0; ++n) face[n] = vertices[static_cast<std::size_t>(side[n])];
    const auto end = face.begin() + static_cast<std::ptrdiff_t>(n);
    if (std::find(face.begin(), end, apex) != end) continue;
    std::rotate(face.begin(), std::min_element(face.begin(), end), end);
    // The face is counter-clockwise from outside, and the apex inside.
    append({face[0], face[2], face[1], apex}, tets);
    if (n == 4) append({face[0], face[3], face[2], apex}, tets);
  }
}

void SplitBlock::add(std::span<const VertexId> vertices, TetMesh& mesh) {
  first_tet_.push_back(static_cast<GlobalId>(mesh.n_tets()));
  vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
  split_element(type_, vertices, mesh.tets);
  end_ = static_cast<GlobalId>(mesh.n_tets());
}

void SplitBlock::append_side(std::size_t element, std::int64_t side, const TetMesh& mesh,
                             std::vector<Side>& sides) const {
  const Shape& shape = shape_of(type_);
  std::vector<VertexId> face;
  for (const std::int8_t v : shape.sides[static_cast<std::size_t>(side - 1)])
    if (v >= 0) face.push_back(vertices_[element * shape.n_vertices + static_cast<std::size_t>(v)]);
  const GlobalId end = element + 1 < first_tet_.size() ? first_tet_[element + 1] : end_;
  const std::vector<Face>& faces_of_tet = shape_of(ElementType::tet4).sides;
  for (GlobalId t = first_tet_[element]; t < end; ++t) {
    const Tet& tet = mesh.tets[static_cast<std::size_t>(t)];
    for (std::size_t s = 0; s < 4; ++s) {
      const bool on_side = std::all_of(
          faces_of_tet[s].begin(), faces_of_tet[s].begin() + 3, [&](std::int8_t corner) {
            return std::find(face.begin(), face.end(), tet[static_cast<std::size_t>(corner)]) !=
                   face.end();
          });
      if (on_side) sides.push_back({t, static_cast<std::int32_t>(s + 1)});
    }
  }
}

}  // namespace tess::m2m
