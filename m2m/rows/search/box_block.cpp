#include "m2m/rows/search/box_block.hpp"

#include "m2m/rows/interpolate/locate.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {

void BoxBlock::load(std::span<const Point> points, std::span<const Tet> tets,
                    std::span<const std::uint32_t> members, double reach) {
  // The order of a mesh is often not spatial, so the members are all over it.
  for (const std::uint32_t t : members) __builtin_prefetch(&tets[t]);
  for (const std::uint32_t t : members)
    for (const VertexId v : tets[t]) __builtin_prefetch(&points[static_cast<std::size_t>(v)]);
  const std::size_t n = n_ = members.size();
  Aabb around = collide::no_box<double, 3>();
  for (std::size_t i = 0; i < n; ++i) {
    const Tet& tet = tets[members[i]];
    Aabb box = collide::box_of(points[static_cast<std::size_t>(tet[0])]);
    for (std::size_t corner = 1; corner < 4; ++corner)
      grow(box, points[static_cast<std::size_t>(tet[corner])]);
    grow(around, box.lo);
    grow(around, box.hi);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low_[axis][i] = box.lo[axis];
      high_[axis][i] = box.hi[axis];
    }
  }
  around_ = padded(around, reach);
  for (std::size_t i = 0; i < n; ++i) {
    const Aabb box = padded(
        {{low_[0][i], low_[1][i], low_[2][i]}, {high_[0][i], high_[1][i], high_[2][i]}}, reach);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low_[axis][i] = box.lo[axis];
      high_[axis][i] = box.hi[axis];
    }
  }
}

void BoxBlock::make_slabs() {
  const std::size_t n = n_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double per_length = n_slabs / (around_.hi[axis] - around_.lo[axis]);
    per_length_[axis] = std::isfinite(per_length) ? per_length : 0;
    std::array<std::uint8_t, capacity> first, last;
    for (std::size_t i = 0; i < n; ++i) {
      first[i] = static_cast<std::uint8_t>(slab(axis, low_[axis][i]));
      last[i] = static_cast<std::uint8_t>(slab(axis, high_[axis][i]));
    }
    // Each box toggles its bit in its first slab and after its last one; sums give the rest.
    auto& reaching = reaching_[axis];
    reaching.fill(0);
    for (std::size_t i = 0; i < n; ++i) {
      reaching[first[i]] ^= std::uint64_t{1} << i;
      reaching[last[i] + std::size_t{1}] ^= std::uint64_t{1} << i;
    }
    for (std::size_t k = 1; k < n_slabs; ++k) reaching[k] ^= reaching[k - 1];
  }
}

std::uint64_t BoxBlock::holding(const Point& p) const {
  // A byte per box, which the compiler makes with vectors; then a bit.
  std::array<std::uint8_t, capacity> held;
  for (std::size_t i = 0; i < capacity; ++i) held[i] = holds(i, p) ? 1 : 0;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < capacity; i += 8) {
    std::uint64_t eight = 0;
    for (std::size_t k = 0; k < 8; ++k) eight |= std::uint64_t{held[i + k]} << k;
    bits |= eight << i;
  }
  return n_ == capacity ? bits : bits & ((std::uint64_t{1} << n_) - 1);
}

}  // namespace tess::m2m
