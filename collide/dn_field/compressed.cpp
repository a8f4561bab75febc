#include "collide/dn_field/compressed.hpp"

#include "collide/dn_field/field/compressed_entry.hpp"
#include "runtime/core/check.hpp"

namespace tess::dn {
namespace {

enum class Want { distance, normal, both };

/// The field's numbers, in registers: the stores of a look-up cannot change them.
struct FieldReader {
  explicit FieldReader(const CompressedField& f)
      : per_cell(static_cast<float>(1 / f.grid.cell)),
        // Half a voxel is added once here, so that truncation rounds to the nearest centre.
        ox(static_cast<float>(0.5 - f.grid.origin.x / f.grid.cell)),
        oy(static_cast<float>(0.5 - f.grid.origin.y / f.grid.cell)),
        oz(static_cast<float>(0.5 - f.grid.origin.z / f.grid.cell)),
        nx(static_cast<float>(f.grid.n[0])),
        ny(static_cast<float>(f.grid.n[1])),
        nz(static_cast<float>(f.grid.n[2])),
        cell(static_cast<float>(f.grid.cell)),
        thickness(static_cast<float>(f.thickness)),
        e(f.block_shift),
        row(f.n_blocks[0]),
        layer(f.n_blocks[0] * f.n_blocks[1]) {}

  float per_cell, ox, oy, oz, nx, ny, nz, cell, thickness;
  int e, row, layer;
};

template <bool wide, Want want>
void read_planes(const CompressedField& field, const Points& points, float* __restrict distance,
                 float* __restrict out_x, float* __restrict out_y, float* __restrict out_z) {
  const FieldReader r(field);
  const EntryDecoder decoder(field.layout);
  const std::uint32_t* __restrict const block = field.block.data();
  const std::uint32_t* __restrict const entry = field.entry.data();
  const float* __restrict const px = points.x.data();
  const float* __restrict const py = points.y.data();
  const float* __restrict const pz = points.z.data();
  const auto count = static_cast<int>(points.x.size());
  for (int p = 0; p < count; ++p) {
    const float u = px[p] * r.per_cell + r.ox, v = py[p] * r.per_cell + r.oy,
                w = pz[p] * r.per_cell + r.oz;
    const bool in = (u >= 0) & (u < r.nx) & (v >= 0) & (v < r.ny) & (w >= 0) & (w < r.nz);
    const int i = static_cast<int>(in ? u : 0.0F), j = static_cast<int>(in ? v : 0.0F),
              k = static_cast<int>(in ? w : 0.0F);
    const auto head =
        static_cast<int>(block[(k >> r.e) * r.layer + (j >> r.e) * r.row + (i >> r.e)]);
    const int s = head & 7, in_block = (1 << r.e) - 1, in_cell = (1 << s) - 1, t = r.e - s;
    const int li = i & in_block, lj = j & in_block, lk = k & in_block;
    const int at = (head >> 3) + ((((lk >> s) << t) + (lj >> s)) << t) + (li >> s);
    Plane plane;
    if constexpr (wide) {
      plane = EntryDecoder::wide(entry[2 * at], entry[2 * at + 1]);
    } else {
      plane = decoder.narrow(entry[at]);
    }
    if constexpr (want != Want::normal) {
      // The middle of a cell stands between voxels: twice the offset is a whole number.
      const float half = 0.5F * r.cell;
      const float x = half * static_cast<float>(2 * (li & in_cell) - in_cell);
      const float y = half * static_cast<float>(2 * (lj & in_cell) - in_cell);
      const float z = half * static_cast<float>(2 * (lk & in_cell) - in_cell);
      const float d = distance_to(plane, x, y, z, r.thickness);
      distance[p] = in ? d : out_of_reach;
    }
    if constexpr (want != Want::distance) {
      out_x[p] = in ? plane.normal.x : 0.0F;
      out_y[p] = in ? plane.normal.y : 0.0F;
      out_z[p] = in ? plane.normal.z : 0.0F;
    }
  }
}

void check_sizes(const Points& points, std::size_t count) {
  TESS_CHECK(points.x.size() == count && points.y.size() == count && points.z.size() == count,
             "expected ", count, " coordinates on each axis");
  TESS_CHECK(count < (std::size_t{1} << 31U), "points are numbered in 31 bits");
}

void check_normals(const CompressedField& field, const NormalColumns& normal, std::size_t count) {
  TESS_CHECK(normal.x.size() == count && normal.y.size() == count && normal.z.size() == count,
             "expected room for ", count, " normals");
  TESS_CHECK(field.content == Content::distance_and_normal, "a field of distances has no normals");
}

}  // namespace

void nearest_distance(const CompressedField& field, const Points& points,
                      std::span<float> distance) {
  check_sizes(points, distance.size());
  const auto run =
      field.layout.wide ? read_planes<true, Want::distance> : read_planes<false, Want::distance>;
  run(field, points, distance.data(), nullptr, nullptr, nullptr);
}

void nearest_normal(const CompressedField& field, const Points& points,
                    const NormalColumns& normal) {
  check_sizes(points, points.x.size());
  check_normals(field, normal, points.x.size());
  const auto run =
      field.layout.wide ? read_planes<true, Want::normal> : read_planes<false, Want::normal>;
  run(field, points, nullptr, normal.x.data(), normal.y.data(), normal.z.data());
}

void nearest(const CompressedField& field, const Points& points, std::span<float> distance,
             const NormalColumns& normal) {
  check_sizes(points, distance.size());
  check_normals(field, normal, distance.size());
  const auto run =
      field.layout.wide ? read_planes<true, Want::both> : read_planes<false, Want::both>;
  run(field, points, distance.data(), normal.x.data(), normal.y.data(), normal.z.data());
}

}  // namespace tess::dn
