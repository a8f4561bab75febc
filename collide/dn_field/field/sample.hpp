// Samples of a flat field, a vector of them at a time, in grid coordinates: voxel (i, j, k) has its
// centre at (i, j, k). Implements the three kinds of look-up. Private to dn_field.
#pragma once

#include "collide/dn_field/geometry/lanes.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/dn_field/normal_code.hpp"

#include <bit>

namespace tess::dn {

/// A flat field as the loops read it.
struct Sampler {
  const float* distance = nullptr;
  const std::uint32_t* normal = nullptr;
  float cell = 1;
  int row = 1, layer = 1;
  int n[3] = {0, 0, 0};
};

inline Sampler sampler_of(const Field& field) {
  const Grid& g = field.grid;
  return {field.distance.data(), field.normal.data(),     static_cast<float>(g.cell), g.n[0],
          g.n[0] * g.n[1],       {g.n[0], g.n[1], g.n[2]}};
}

/// What a loop computes.
enum class Ask : std::uint32_t { distance, both };

struct Sample {
  lanes::I in;        ///< whether the field covers the point; otherwise the distances mean nothing
  lanes::F distance;  ///< in units of the object
  lanes::F3 normal;   ///< unit or zero; zero outside
  lanes::F free;      ///< lower bound of the distance: the voxel's, less the way from its centre
                      ///< (trilinear: less the longest such way)

  [[nodiscard]] lanes::F distance_or_far() const {
    return in ? distance : lanes::all(out_of_reach);
  }
};

namespace lanes {

/// The point of the octahedron |x| + |y| + |z| = 1 that unfolds to (u, v).
inline F3 on_octahedron(F u, F v) {
  const F z = 1.0F - abs(u) - abs(v);
  const F fold = z < 0.0F ? -z : F{};
  const I sign = I{} + std::bit_cast<std::int32_t>(0x80000000U);
  return {u - (F)((I)fold | ((I)u & sign)), v - (F)((I)fold | ((I)v & sign)), z};
}

/// decode_normal() before it is normalised; zero for no_normal.
inline F3 decode(I code) {
  const F u = __builtin_convertvector((code << 16) >> 16, F) * (1 / code_scale);
  const F v = __builtin_convertvector(code >> 16, F) * (1 / code_scale);
  return only(code != I{} + std::bit_cast<std::int32_t>(no_normal), on_octahedron(u, v));
}

/// Unit, or zero where `n` is shorter than a thousandth: blends of opposite normals.
inline F3 unit(F3 n) {
  const F square = dot(n, n);
  const F scale = only(square > 1e-6F, 1.0F / sqrt(square));
  return scale * n;
}

/// The voxel that contains a point.
struct Voxel {
  I in;       ///< whether there is one; otherwise (0, 0, 0) is read instead
  I i, j, k;  ///< along the axes
};

/// In a grid of n voxels; `h` are coordinates from the grid's corner.
inline Voxel voxel_from_corner(const int (&n)[3], F3 h) {
  const auto nx = static_cast<float>(n[0]), ny = static_cast<float>(n[1]),
             nz = static_cast<float>(n[2]);
  const I in = (h.x >= 0.0F) & (h.x < nx) & (h.y >= 0.0F) & (h.y < ny) & (h.z >= 0.0F) & (h.z < nz);
  return {in, __builtin_convertvector(only(in, h.x), I), __builtin_convertvector(only(in, h.y), I),
          __builtin_convertvector(only(in, h.z), I)};
}
inline Voxel voxel_of(const int (&n)[3], F3 g) {
  return voxel_from_corner(n, {g.x + 0.5F, g.y + 0.5F, g.z + 0.5F});
}

/// The index of a voxel in the field's arrays.
inline I position(const Sampler& field, const Voxel& voxel) {
  return voxel.k * field.layer + voxel.j * field.row + voxel.i;
}

/// From the voxel's centre to the point.
inline F3 offset(const Voxel& voxel, F3 g) {
  return {g.x - __builtin_convertvector(voxel.i, F), g.y - __builtin_convertvector(voxel.j, F),
          g.z - __builtin_convertvector(voxel.k, F)};
}

/// A voxel's distance and normal; the normal is unit or zero, and zero if there is no voxel.
struct Stored {
  F distance;
  F3 normal;
};

template <LookUp Kind, Ask Asked>
inline Stored read(const Sampler& field, const Voxel& voxel) {
  Stored stored{};
  const I at = position(field, voxel);
  if constexpr (Asked == Ask::both || Kind == LookUp::tangent)
    stored.normal = only(voxel.in, unit(decode(gather(field.normal, at))));
  stored.distance = gather(field.distance, at);
  return stored;
}

/// Reads distance and normal where `changed`; otherwise `before` holds what would be read.
inline Stored read_changed(const Sampler& field, const Voxel& voxel, I changed,
                           const Stored& before) {
  const I at = position(field, voxel);
  const F3 normal = only(voxel.in, unit(decode(gather(field.normal, at, changed))));
  const F distance = gather(field.distance, at, changed);
  return {changed ? distance : before.distance, select(changed, normal, before.normal)};
}

/// The sample at g from the voxel's data.
template <LookUp Kind>
inline Sample answer(float cell, const Voxel& voxel, const Stored& stored, F3 g) {
  const F3 from = offset(voxel, g);
  Sample found{voxel.in, stored.distance, stored.normal,
               stored.distance - cell * sqrt(dot(from, from))};
  if constexpr (Kind == LookUp::tangent)
    found.distance = stored.distance + cell * dot(stored.normal, from);
  return found;
}

template <LookUp Kind, Ask Asked>
  requires(Kind != LookUp::trilinear)
inline Sample sample(const Sampler& field, F3 g) {
  const Voxel voxel = voxel_of(field.n, g);
  return answer<Kind>(field.cell, voxel, read<Kind, Asked>(field, voxel), g);
}

template <LookUp Kind, Ask Asked>
  requires(Kind == LookUp::trilinear)
inline Sample sample(const Sampler& field, F3 g) {
  const auto nx = static_cast<float>(field.n[0] - 1), ny = static_cast<float>(field.n[1] - 1),
             nz = static_cast<float>(field.n[2] - 1);
  const I in =
      (g.x >= 0.0F) & (g.x <= nx) & (g.y >= 0.0F) & (g.y <= ny) & (g.z >= 0.0F) & (g.z <= nz);
  const F3 h = only(in, g);
  // The last cell includes its far face.
  const I i = __builtin_convertvector(min(h.x, all(nx - 1)), I),
          j = __builtin_convertvector(min(h.y, all(ny - 1)), I),
          k = __builtin_convertvector(min(h.z, all(nz - 1)), I);
  const F u = h.x - __builtin_convertvector(i, F), v = h.y - __builtin_convertvector(j, F),
          w = h.z - __builtin_convertvector(k, F);
  const I corner = k * field.layer + j * field.row + i;
  Sample found{};
  found.in = in;
  for (int edge = 0; edge < 4; ++edge) {  // along x
    const int dy = edge & 1, dz = edge >> 1;
    const I at = corner + (dz * field.layer + dy * field.row);
    const F beside = (dy != 0 ? v : 1.0F - v) * (dz != 0 ? w : 1.0F - w);
    const F low = (1.0F - u) * beside, high = u * beside;
    const auto [first, second] = gather_two(field.distance, at);
    found.distance = found.distance + (low * first + high * second);
    if constexpr (Asked == Ask::both) {
      const auto [one, other] = gather_two(field.normal, at);
      found.normal = found.normal + (low * decode(one) + high * decode(other));
    }
  }
  found.free = found.distance - half_diagonal * field.cell;
  if constexpr (Asked == Ask::both) found.normal = only(in, unit(found.normal));
  return found;
}

}  // namespace lanes
}  // namespace tess::dn
