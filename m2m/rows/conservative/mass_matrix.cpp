#include "m2m/rows/conservative/mass_matrix.hpp"

#include "m2m/rows/interpolate/orientation.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {

std::vector<std::int32_t> tets_at_owned(const MeshView& mesh) {
  std::vector<std::int32_t> numbers;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (std::any_of(mesh.tets[t].begin(), mesh.tets[t].end(),
                    [&](VertexId v) { return v < mesh.n_owned; }))
      numbers.push_back(static_cast<std::int32_t>(t));
  std::sort(numbers.begin(), numbers.end(), [&](std::int32_t a, std::int32_t b) {
    return mesh.tet_ids[static_cast<std::size_t>(a)] < mesh.tet_ids[static_cast<std::size_t>(b)];
  });
  return numbers;
}

double size_of(const MeshView& mesh, const Tet& cell) {
  const auto c = corners_of(mesh.points, cell);
  return mesh.dimension == 3 ? std::abs(orientation(c[0], c[1], c[2], c[3])) / 6
                             : measure(c, mesh.dimension);
}

MassMatrix::MassMatrix(const MeshView& mesh, std::span<const std::int32_t> numbers,
                       std::span<const std::array<double, 4>> covered)
    : n_points_(mesh.points.size()), n_corners_(static_cast<std::size_t>(mesh.dimension) + 1) {
  TESS_CHECK(covered.size() == numbers.size(), "expected four loads for each of ", numbers.size(),
             " tetrahedra, got ", covered.size());
  const auto n_owned = static_cast<std::size_t>(mesh.n_owned);
  rest_.assign(n_owned, 0);
  lumped_.assign(n_owned, 0);
  fractions_.assign(n_owned, 0);
  inverse_.assign(n_owned, 0);
  std::vector<double> whole(n_owned, 0);
  const auto n = static_cast<double>(n_corners_);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const Tet& tet = mesh.tets[static_cast<std::size_t>(numbers[k])];
    const double volume = size_of(mesh, tet);
    const std::array<double, 4>& c = covered[k];
    const double e =
        *std::min_element(c.begin(), c.begin() + static_cast<std::ptrdiff_t>(n_corners_)) / (n + 1);
    tets_.push_back(tet);
    off_diagonal_.push_back(e);
    for (std::size_t a = 0; a < n_corners_; ++a) {
      if (tet[a] >= mesh.n_owned) continue;
      const auto v = static_cast<std::size_t>(tet[a]);
      lumped_[v] += c[a];
      whole[v] += volume / n;
      rest_[v] += std::max(c[a] - (n + 1) * e, 0.0);
      inverse_[v] += 2 * e;
    }
  }
  for (std::size_t v = 0; v < n_owned; ++v) {
    const double diagonal = inverse_[v] + rest_[v];
    inverse_[v] = diagonal > 0 ? 1 / diagonal : 0;
    if (whole[v] > 0) fractions_[v] = lumped_[v] / whole[v];
  }
}

void MassMatrix::multiply(std::span<const double> x, std::size_t n_components,
                          std::span<double> y) const {
  for (std::size_t v = 0; v < n_owned(); ++v)
    for (std::size_t c = 0; c < n_components; ++c)
      y[v * n_components + c] = rest_[v] * x[v * n_components + c];
  for_each_element([&](const Tet& tet, double e) {
    std::array<std::size_t, 4> row;
    for (std::size_t a = 0; a < 4; ++a) row[a] = static_cast<std::size_t>(tet[a]) * n_components;
    for (std::size_t c = 0; c < n_components; ++c) {
      const double fourth = n_corners_ < 4 ? 0 : x[row[3] + c];
      const double sum = (x[row[0] + c] + x[row[1] + c]) + (x[row[2] + c] + fourth);
      for (std::size_t a = 0; a < n_corners_; ++a)
        if (row[a] < y.size()) y[row[a] + c] += e * (x[row[a] + c] + sum);
    }
  });
}

}  // namespace tess::m2m
