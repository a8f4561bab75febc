// Generated overset meshes: a body of some shape, and around it layers of tetrahedra out to a
// surface of the same shape.
//
//     ball:12    box:12    star:12    torus:12        the number sets the triangles of the surface
//     ball:12@0.3:0.5:0    ball:12@0.3:0.5:0:0.1      its centre, and its radius
#pragma once

#include "m2m/overset.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace overset {

using tess::m2m::Point;
using tess::m2m::VertexId;

struct Body {
  enum class Shape : std::uint8_t { ball, box, star, torus };
  Shape shape = Shape::ball;
  std::int32_t n = 12;        ///< edges across a side (2 or more), and 2 n around a torus' tube
  std::int32_t n_layers = 0;  ///< 0: n / 2
  Point centre{0.5, 0.5, 0.5};
  double radius = 0.2;        ///< of the body
  double outer = 2.0;         ///< the outer surface is so many times larger; a torus' tube thicker
  Point turn{0.3, 0.5, 0.7};  ///< angles about x, y, z in radians, in this order
  /// Per axis of the body: 1 or -1 keeps the half on that side of the centre, 0 keeps all.
  std::array<std::int32_t, 3> half{};
};

/// True for "ball" and the like.
[[nodiscard]] bool names_shape(std::string_view name);
/// True for "ball:12" and the like.
[[nodiscard]] bool names_body(std::string_view name);
/// A body without a place stands in the middle of the planes of symmetry. One whose centre is in
/// such planes is not turned, and only the part in the domain is kept. Throws Error (bad_argument)
/// for a number that is not from 2 to 200, and for such a plane that is not across an axis.
[[nodiscard]] Body parse_body(std::string_view name,
                              std::span<const tess::m2m::SymmetryPlane> symmetry = {});

/// Inside out: point v of layer k has the number k × (points of the surface) + v. All tetrahedra
/// have positive orientation where the shape is not too coarse. Throws Error (bad_argument) if a
/// triangle of the surface crosses a plane in which the body is cut.
[[nodiscard]] tess::m2m::TetMesh mesh_around(const Body& body);

/// The triangles of layer 0, their normals out of the body.
[[nodiscard]] std::vector<std::array<VertexId, 3>> surface_of(const Body& body);

}  // namespace overset
