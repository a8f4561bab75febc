#include "m2m/rows/supermesh/moments.hpp"

#include "m2m/rows/interpolate/orientation.hpp"
#include "m2m/rows/supermesh/polyhedron.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {
namespace {

/// If six times the volume of the cutting tetrahedron exceeds this multiple of the box around both,
/// the rounding errors of its weights are below 1e-10 (as in locate.cpp).
constexpr double flat_limit = 4 * 6 * orientation_bound * 1e10;
/// If heights() exceed this multiple of their sure_height(), errors of weights are below 1e-14.
constexpr double flat_height = 0x1p37;

/// Heights above such a tetrahedron may be mostly rounding; only their signs are exact.
bool is_flat(const Corners& carried, const Corners& cutting, double sixfold) {
  double product = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    double low = carried[0][k], high = low;
    for (const Corners* corners : {&carried, &cutting})
      for (const Point& p : *corners) {
        low = std::min(low, p[k]);
        high = std::max(high, p[k]);
      }
    product *= high - low;
  }
  return !(std::abs(sixfold) > flat_limit * product);
}

/// Heights with exact signs.
Heights exact_heights(const TetPlanes& cutting, const TetPlanes& carried) {
  const Corners c = cutting.corners(), of = carried.corners();
  Heights result;
  const auto compute = [&](auto&& orient) {
    for (std::size_t f = 0; f < 4; ++f)
      for (std::size_t v = 0; v < 4; ++v) {
        const double height =
            orient(of[v], c[faces_of_tet[f][0]], c[faces_of_tet[f][1]], c[faces_of_tet[f][2]]);
        result[f][v] = cutting.sixfold > 0 ? height : -height;
      }
  };
  compute(orientation);
  if (is_flat(of, c, cutting.sixfold)) compute(orientation_exact);
  return result;
}

bool are_sure(const Heights& h, double sure) {
  const Four least = simd::min(simd::min(simd::abs(h[0]), simd::abs(h[1])),
                               simd::min(simd::abs(h[2]), simd::abs(h[3])));
  return !simd::any(least <= sure);
}

}  // namespace

TetPlanes::TetPlanes(const Corners& c) : sixfold(orientation(c[0], c[1], c[2], c[3])) {
  const std::array<Point, 3> e{difference(c[1], c[0]), difference(c[2], c[0]),
                               difference(c[3], c[0])};
  const std::array<Point, 3> n{cross(e[1], e[2]), cross(e[2], e[0]), cross(e[0], e[1])};
  const double sign = sixfold < 0 ? -1 : 1;
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = Four{c[0][k], c[1][k], c[2][k], c[3][k]};
    for (const Point& edge : e) reach = std::max(reach, std::abs(edge[k]));
    normal[k] = sign * Four{-(n[0][k] + n[1][k] + n[2][k]), n[0][k], n[1][k], n[2][k]};
  }
  base[0] = std::abs(sixfold);
}

/// False: the heights of corners are mostly rounding beside the volume of a flat tetrahedron.
bool PairCutter::is_plain(const Pair& pair) {
  return std::abs(pair.cutting->sixfold) > flat_height * sure_height(*pair.cutting, *pair.carried);
}

template <std::size_t face>
void PairCutter::cut_by() {
  std::size_t n = 0;
  for (const std::uint32_t k : left_) {
    left_[n] = k;
    n += overlaps_[k].cut<face>() ? 1U : 0U;
  }
  left_.resize(n);
}

void PairCutter::cut_all() {
  overlaps_.clear();
  left_.clear();
  for (std::uint32_t k = 0; k < n_; ++k) {
    const Pair& pair = pairs_[k];
    const bool sure =
        is_plain(pair) && are_sure(pair.heights, sure_height(*pair.cutting, *pair.carried));
    overlaps_.emplace_back(sure ? pair.heights : exact_heights(*pair.cutting, *pair.carried));
    if (pair.carried->sixfold != 0 && pair.cutting->sixfold != 0) left_.push_back(k);
  }
  cut_by<0>();
  cut_by<1>();
  cut_by<2>();
  cut_by<3>();
}

PairMoments PairCutter::moments_of(std::uint32_t k) {
  const Pair& pair = pairs_[k];
  const bool plain = is_plain(pair);
  if (!plain) overlaps_[k].heights_to_weights();
  const Polyhedron::Integrals integrals = overlaps_[k].integrals();
  const double volume = std::abs(pair.carried->sixfold) / 6;
  const double unit = volume / 20 / (plain ? std::abs(pair.cutting->sixfold) : 1);
  PairMoments result;
  result.volume = integrals.volume * volume;
  std::array<Four, 4> rows;  // without branches: which one is carried is not predictable
  for (std::size_t s = 0; s < 4; ++s)
    for (std::size_t t = 0; t < 4; ++t) {
      const std::size_t at = pair.carries_target ? 4 * t + s : 4 * s + t;
      rows[s][t] = integrals.mixed[at / 8][at % 8];
    }
  for (std::size_t s = 0; s < 4; ++s)
    simd::store(result.mixed[s].data(), simd::max(rows[s] * unit, Four{}));
  return result;
}

PairMoments pair_moments(const Corners& source, const Corners& target) {
  PairMoments result;
  if (!collide::overlap(collide::box_around(source), collide::box_around(target),
                        collide::Touching::does_not_count))
    return result;
  const TetPlanes s(source), t(target);
  PairCutter cutter;
  cutter.add(s, t, 0);
  cutter.cut([&](std::int32_t /*number*/, const PairMoments& moments) { result = moments; });
  return result;
}

double overlap_volume(const Corners& a, const Corners& b) {
  return pair_moments(a, b).volume;
}

}  // namespace tess::m2m
