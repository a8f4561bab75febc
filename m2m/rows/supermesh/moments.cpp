#include "m2m/rows/supermesh/moments.hpp"

#include "m2m/rows/interpolate/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tess::m2m {
namespace {

/// If six times the volume of the cutting tetrahedron exceeds this multiple of the box around both,
/// the rounding errors of its weights are below 1e-10 (as in locate.cpp).
constexpr double flat_limit = 4 * 6 * orientation_bound * 1e10;

/// Heights of the corners of one tetrahedron above the faces of another one, which cuts.
struct Heights {
  std::array<Weights, 4> above;
  bool apart = false;  ///< a face separates the tetrahedra: no volume in common
};

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

/// `sixfold`: six times the volume of `cutting`, with its sign. A height is six times the volume of
/// the tetrahedron over the face, so four heights of a point add up to |sixfold|.
Heights heights_above(const Corners& carried, const Corners& cutting, double sixfold) {
  Heights result{};
  const auto compute = [&](auto&& orient) {
    for (std::size_t f = 0; f < 4; ++f) {
      bool any = false;
      for (std::size_t v = 0; v < 4; ++v) {
        const double volume = orient(carried[v], cutting[faces_of_tet[f][0]],
                                     cutting[faces_of_tet[f][1]], cutting[faces_of_tet[f][2]]);
        const double height = sixfold > 0 ? volume : -volume;
        result.above[v][f] = height;
        any = any || height > 0;
      }
      result.apart = !any;
      if (result.apart) return;
    }
  };
  compute(orientation);
  if (!result.apart && is_flat(carried, cutting, sixfold)) compute(orientation_exact);
  return result;
}

double sixfold_volume(const Corners& c) {
  return orientation(c[0], c[1], c[2], c[3]);
}

/// Two tetrahedra with the carried one chosen.
struct Pair {
  const Corners& carried;
  const Corners& cutting;
  double carried_volume;   // absolute
  double cutting_sixfold;  // with sign
  bool target_carried;
};
std::optional<Pair> pair_of(const Corners& source, const Corners& target) {
  const double s = sixfold_volume(source), t = sixfold_volume(target);
  if (s == 0 || t == 0) return std::nullopt;
  if (std::abs(t) <= std::abs(s)) return Pair{target, source, std::abs(t) / 6, s, true};
  return Pair{source, target, std::abs(s) / 6, t, false};
}

/// The volume of K, and integrals over it of a weight of the carried tetrahedron times one of the
/// cutting tetrahedron, as fractions of the carried volume.
struct CarriedMoments {
  double volume = 0;
  Matrix4 mixed{};  // [carried][cutting]
};

/// The weights of the cutting tetrahedron at a vertex of K. There no height is negative but by
/// rounding, so they add up without cancellation. (At corners of the carried tetrahedron, far
/// outside of a flat cutting one, they do not.)
Weights cutting_weights(const Polyhedron::Vertex& vertex) {
  Weights w;
  for (std::size_t k = 0; k < 4; ++k) w[k] = std::max(vertex.heights[k], 0.0);
  const double total = (w[0] + w[1]) + (w[2] + w[3]);
  for (double& x : w) x = total > 0 ? x / total : 0.25;
  return w;
}

/// The integral of r_a s_c over a tetrahedron with linear r and s is
/// V / 20 (sum over corners of r_a s_c + (sum of r_a) (sum of s_c)).
CarriedMoments moments_of(const Polyhedron& polyhedron) {
  CarriedMoments result;
  polyhedron.for_each_piece([&](double fraction, const auto&... corner) {
    result.volume += fraction;
    const std::array<Weights, 4> r{corner.weights...}, s{cutting_weights(corner)...};
    Weights all_r, all_s;
    for (std::size_t k = 0; k < 4; ++k) {
      all_r[k] = (r[0][k] + r[1][k]) + (r[2][k] + r[3][k]);
      all_s[k] = (s[0][k] + s[1][k]) + (s[2][k] + s[3][k]);
    }
    const double scale = fraction / 20;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t c = 0; c < 4; ++c) {
        result.mixed[a][c] +=
            scale *
            (((r[0][a] * s[0][c] + r[1][a] * s[1][c]) + (r[2][a] * s[2][c] + r[3][a] * s[3][c])) +
             all_r[a] * all_s[c]);
      }
    }
  });
  return result;
}

Matrix4 transposed(const Matrix4& a) {
  Matrix4 out;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) out[i][j] = a[j][i];
  return out;
}
void scale(Matrix4& a, double factor) {
  for (Weights& row : a)
    for (double& x : row) x *= factor;
}

}  // namespace

double overlap_volume(const Corners& a, const Corners& b) {
  const auto pair = pair_of(a, b);
  if (!pair) return 0;
  const Heights heights = heights_above(pair->carried, pair->cutting, pair->cutting_sixfold);
  if (heights.apart) return 0;
  Polyhedron polyhedron(heights.above);
  if (!polyhedron.cut()) return 0;
  double fraction = 0;
  polyhedron.for_each_piece([&](double piece, const auto&...) { fraction += piece; });
  return fraction * pair->carried_volume;
}

PairMoments pair_moments(const Corners& source, const Corners& target) {
  PairMoments result;
  const auto pair = pair_of(source, target);
  if (!pair) return result;
  const Heights heights = heights_above(pair->carried, pair->cutting, pair->cutting_sixfold);
  if (heights.apart) return result;
  Polyhedron polyhedron(heights.above);
  if (!polyhedron.cut()) return result;
  CarriedMoments moments = moments_of(polyhedron);
  if (!(moments.volume > 0)) return result;
  result.volume = moments.volume * pair->carried_volume;
  Matrix4& mixed = moments.mixed;
  scale(mixed, pair->carried_volume);
  result.mixed = pair->target_carried ? transposed(mixed) : mixed;
  return result;
}

}  // namespace tess::m2m
