#include "m2m/rows/supermesh/polyhedron.hpp"

#include <bit>
#include <cmath>

namespace tess::m2m {
namespace {

constexpr std::size_t n_planes = 8, n_pairs = 28;
constexpr std::uint32_t all_bits = ~std::uint32_t{0};

/// Pairs of planes, ordered by the later one: with the first n planes come n (n - 1) / 2 pairs.
struct PlanePairs {
  std::array<std::uint32_t, 32> first{}, second{};             // the last four are no pairs
  std::array<std::array<std::uint32_t, n_planes>, 32> both{};  // all bits in both planes
};
constexpr PlanePairs plane_pairs = [] {
  PlanePairs pairs;
  std::size_t at = 0;
  for (std::uint32_t q = 1; q < n_planes; ++q)
    for (std::uint32_t p = 0; p < q; ++p, ++at) {
      pairs.first[at] = p;
      pairs.second[at] = q;
      pairs.both[at][p] = pairs.both[at][q] = all_bits;
    }
  return pairs;
}();

template <class Planes>
Planes per_pair(Planes planes, const std::array<std::uint32_t, 32>& side, std::size_t first) {
  return __builtin_shuffle(planes, simd::load<Planes>(side.data() + first));
}

template <class V>
V splat_high(V v) {
  using Lanes = decltype(v < v);
  return __builtin_shuffle(v, Lanes{4, 5, 6, 7, 4, 5, 6, 7});
}

/// Adds factor × weight a × height c.
void add_product(Polyhedron::Integrals& to, double factor, Polyhedron::Vertex v) {
  using Lanes = decltype(v < v);
  const Polyhedron::Vertex heights = factor * splat_high(v);
  to.mixed[0] += heights * __builtin_shuffle(v, Lanes{0, 0, 0, 0, 1, 1, 1, 1});
  to.mixed[1] += heights * __builtin_shuffle(v, Lanes{2, 2, 2, 2, 3, 3, 3, 3});
}

std::size_t lowest(std::uint32_t bits) {
  return static_cast<std::size_t>(std::countr_zero(bits));
}
std::size_t highest(std::uint32_t bits) {
  return static_cast<std::size_t>(31 - std::countl_zero(bits));
}

}  // namespace

Polyhedron::Polyhedron(const Heights& heights) : on_{0b1110, 0b1101, 0b1011, 0b0111, 0, 0, 0, 0} {
  for (std::size_t v = 0; v < 4; ++v) {
    vertices_[v] = Vertex{0, 0, 0, 0, heights[0][v], heights[1][v], heights[2][v], heights[3][v]};
    vertices_[v][v] = 1;
  }
  for (std::size_t f = 0; f < 4; ++f) above_[f] = simd::bits(heights[f] > 0);
}

// The point of an edge at the height zero. Swapping both ends and all signs gives the same bits, so
// the two tetrahedra at a face cut alike (unless only one of them is flat, moments.cpp).
template <std::size_t face>
bool Polyhedron::cut() {
  constexpr std::size_t plane = 4 + face, n_known = plane * (plane - 1) / 2;
  const std::uint32_t in = left_ & above_[face], out = left_ & ~in;
  if (in == 0 || out == 0) return in != 0;
  alignas(Planes) std::array<std::uint32_t, 32> ends;
  std::uint32_t crossed = 0;
  for (std::size_t pair = 0; pair < n_known; pair += n_planes) {
    const Planes shared =
        per_pair(on_, plane_pairs.first, pair) & per_pair(on_, plane_pairs.second, pair);
    simd::store(ends.data() + pair, shared);
    crossed |= (0xFF & ~(simd::disjoint(0xFF, shared, Planes{} + in) |
                         simd::disjoint(0xFF, shared, Planes{} + out)))
               << pair;
  }
  Planes added{};
  auto above = above_;
  std::uint32_t n = n_;
  for (crossed &= (1U << n_known) - 1; crossed != 0; crossed &= crossed - 1, ++n) {
    const std::size_t pair = lowest(crossed);
    const Vertex &a = vertices_[lowest(ends[pair] & in)], &b = vertices_[lowest(ends[pair] & out)];
    const double from = a[plane], to = b[plane];
    Vertex vertex = from / (from - to) * b + -to / (from - to) * a;
    vertex[plane] = 0;
    vertices_[n] = vertex;
    added |= simd::load<Planes>(plane_pairs.both[pair].data()) & (1U << n);
    const Four h{vertex[4], vertex[5], vertex[6], vertex[7]};
    above |= __builtin_convertvector(h > 0, decltype(above)) & (1U << n);
  }
  const Planes beyond_first = added & (added - 1);
  if (simd::any((beyond_first & (beyond_first - 1)) != 0)) {
    // A face that is crossed more than twice lies in the plane, up to rounding: what is left lies on
    // one side of both.
    double sum = 0;
    for (std::uint32_t v = left_; v != 0; v &= v - 1) sum += vertices_[lowest(v)][plane];
    return sum > 0;
  }
  left_ = in | ((1U << n) - (1U << n_));
  on_ = (on_ & in) | added;
  on_[plane] = left_ & ~in;
  above_ = above;
  n_ = n;
  return true;
}
template bool Polyhedron::cut<0>();
template bool Polyhedron::cut<1>();
template bool Polyhedron::cut<2>();
template bool Polyhedron::cut<3>();

void Polyhedron::heights_to_weights() {
  for (std::uint32_t rest = left_; rest != 0; rest &= rest - 1) {
    Vertex& v = vertices_[lowest(rest)];
    for (std::size_t k = 4; k < 8; ++k) v[k] = v[k] > 0 ? v[k] : 0;
    const double total = (v[4] + v[5]) + (v[6] + v[7]);
    for (std::size_t k = 4; k < 8; ++k) v[k] = total > 0 ? v[k] / total : 0.25;
  }
}

// The pieces are tetrahedra: the first vertex of all, the first one of a face without it, and an edge
// of that face without that one. The integral of r_a s_c over a piece of the volume V with linear r
// and s is V / 20 (sum over corners of r_a s_c + (sum of r_a) (sum of s_c)).
Polyhedron::Integrals Polyhedron::integrals() const {
  const std::size_t apex_at = lowest(left_);
  const Vertex apex = vertices_[apex_at];
  const Planes faces = simd::only((on_ & (1U << apex_at)) == 0, on_);
  const Planes bases = faces & -faces;
  alignas(Planes) std::array<std::uint32_t, 32> edges;
  alignas(Planes) std::array<std::array<std::uint32_t, 32>, 2> base;
  std::array<std::uint32_t, 2> is_piece{};
  for (std::size_t pair = 0; pair < n_pairs; pair += n_planes) {
    const Planes edge =
        per_pair(on_, plane_pairs.first, pair) & per_pair(on_, plane_pairs.second, pair);
    simd::store(edges.data() + pair, edge);
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& planes = side == 0 ? plane_pairs.first : plane_pairs.second;
      const Planes at = per_pair(bases, planes, pair);
      simd::store(base[side].data() + pair, at);
      const simd::Bits none = simd::disjoint(0xFF, edge, per_pair(faces, planes, pair));
      is_piece[side] |= simd::disjoint(0xFF & ~none, edge, at) << pair;
    }
  }
  Integrals result;
  std::array<double, capacity> around{};  // the volume of the pieces at each vertex
  for (std::size_t side = 0; side < 2; ++side)
    for (std::uint32_t rest = is_piece[side] & ((1U << n_pairs) - 1); rest != 0; rest &= rest - 1) {
      const std::size_t pair = lowest(rest);
      const std::array<std::size_t, 3> at{lowest(base[side][pair]), lowest(edges[pair]),
                                          highest(edges[pair])};
      const Vertex &a = vertices_[at[0]], &b = vertices_[at[1]], &c = vertices_[at[2]];
      // Three of the four coordinates are enough for volumes.
      const auto arm = [&](const Vertex& v) {
        return Point{v[1] - apex[1], v[2] - apex[2], v[3] - apex[3]};
      };
      const double volume = std::abs(dot(arm(a), cross(arm(b), arm(c))));
      result.volume += volume;
      for (const std::size_t v : at) around[v] += volume;
      add_product(result, volume, (apex + a) + (b + c));
    }
  around[apex_at] = result.volume;
  for (std::uint32_t rest = left_; rest != 0; rest &= rest - 1)
    add_product(result, around[lowest(rest)], vertices_[lowest(rest)]);
  return result;
}

}  // namespace tess::m2m
