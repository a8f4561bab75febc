#include "m2m/supermesh/moments.hpp"

#include "m2m/interpolate/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tess::m2m {
namespace {

/// Heights of the corners of one tetrahedron above the faces of another one, which cuts.
struct Heights {
  std::array<Weights, 4> above;
  bool apart = false;  ///< a face separates the tetrahedra: no volume in common
};

/// `sixfold`: six times the volume of `cutting`, with its sign. A height is six times the volume of
/// the tetrahedron over the face, so four heights of a point add up to |sixfold|.
Heights heights_above(const Corners& carried, const Corners& cutting, double sixfold) {
  Heights result{};
  for (std::size_t f = 0; f < 4; ++f) {
    bool any = false;
    for (std::size_t v = 0; v < 4; ++v) {
      const double volume = orientation(carried[v], cutting[faces_of_tet[f][0]],
                                        cutting[faces_of_tet[f][1]], cutting[faces_of_tet[f][2]]);
      const double height = sixfold > 0 ? volume : -volume;
      result.above[v][f] = height;
      any = any || height > 0;
    }
    if (!any) {
      result.apart = true;
      break;
    }
  }
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

/// Integrals over K of products of two weights of the carried tetrahedron, and the volume, both as
/// fractions of the carried volume.
struct CarriedMoments {
  double volume = 0;
  Matrix4 products{};
};

/// The integral of r_a r_c over a tetrahedron with linear r is
/// V / 20 (sum over corners of r_a r_c + (sum of r_a) (sum of r_c)).
CarriedMoments moments_of(const Polyhedron& polyhedron) {
  CarriedMoments result;
  Matrix4 sum{};
  polyhedron.for_each_piece(
      [&](double fraction, const Weights& p, const Weights& q, const Weights& r, const Weights& s) {
        result.volume += fraction;
        const double scale = fraction / 20;
        Weights total;
        for (std::size_t k = 0; k < 4; ++k) total[k] = (p[k] + q[k]) + (r[k] + s[k]);
        for (std::size_t a = 0; a < 4; ++a) {
          for (std::size_t c = 0; c < 4; ++c) {
            sum[a][c] += scale * (((p[a] * p[c] + q[a] * q[c]) + (r[a] * r[c] + s[a] * s[c])) +
                                  total[a] * total[c]);
          }
        }
      });
  result.products = sum;
  return result;
}

Matrix4 product(const Matrix4& a, const Matrix4& b) {
  Matrix4 out{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t j = 0; j < 4; ++j) out[i][j] += a[i][k] * b[k][j];
  return out;
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
  return std::max(fraction, 0.0) * pair->carried_volume;
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
  scale(moments.products, pair->carried_volume);
  // The weights of the cutting tetrahedron at the corners of the carried one; they extend linearly.
  Matrix4 cutting = heights.above;
  for (Weights& row : cutting) {
    const double total = (row[0] + row[1]) + (row[2] + row[3]);
    for (double& x : row) x /= total;
  }
  const Matrix4 mixed = product(moments.products, cutting);  // [carried][cutting]
  result.mixed = pair->target_carried ? transposed(mixed) : mixed;
  return result;
}

}  // namespace tess::m2m
