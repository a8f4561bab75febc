#include "m2m/rows/conservative/mass_matrix.hpp"

#include "m2m/kuhn.hpp"
#include "tests/m2m/overlapping.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <random>

using namespace tess::m2m;

namespace {

struct Masses {
  explicit Masses(const TetMesh& mesh) : ids(mesh.n_tets()) {
    std::iota(ids.begin(), ids.end(), 0);
    view = {mesh.points, mesh.tets, {}, ids, static_cast<std::int64_t>(mesh.n_points())};
    numbers = tets_at_owned(view);
    covered.resize(mesh.n_tets());
    for (std::size_t t = 0; t < mesh.n_tets(); ++t) covered[t].fill(signed_volume(mesh, t) / 4);
  }
  std::vector<GlobalId> ids;
  MeshView view;
  std::vector<std::int32_t> numbers;
  std::vector<std::array<double, 4>> covered;
};

}  // namespace

TEST_CASE("where the source covers all, the matrix integrates products of linear functions",
          "[m2m][conservative]") {
  const TetMesh mesh = kuhn_mesh({3, 0.2});
  const Masses masses(mesh);
  const MassMatrix matrix(masses.view, masses.numbers, masses.covered);
  std::vector<double> x, product(mesh.n_points());
  for (const Point& p : mesh.points) x.push_back(p[0]);
  matrix.multiply(x, 1, product);
  double integral = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    integral += x[v] * product[v];
    CHECK(matrix.covered_fractions()[v] == Approx(1).epsilon(1e-14));
  }
  CHECK(integral == Approx(1.0 / 3).epsilon(1e-13));  // of x² over the unit cube
}

TEST_CASE("for any coverage the row sums are the loads of 1, and eigenvalues are in [1/2, 5/2]",
          "[m2m][conservative]") {
  const TetMesh mesh = kuhn_mesh({3, 0.2});
  Masses masses(mesh);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (std::size_t t = 0; t < mesh.n_tets(); ++t)
    for (std::size_t a = 0; a < 4; ++a)
      masses.covered[t][a] *= t % 5 == 0 ? 0 : t % 5 == 1 ? 1 : std::pow(uniform(random), 4);
  const MassMatrix matrix(masses.view, masses.numbers, masses.covered);
  const std::size_t n = mesh.n_points();
  std::vector<double> ones(n, 1), sums(n), want(n, 0);
  matrix.multiply(ones, 1, sums);
  for (std::size_t t = 0; t < mesh.n_tets(); ++t)
    for (std::size_t a = 0; a < 4; ++a)
      want[static_cast<std::size_t>(mesh.tets[t][a])] += masses.covered[t][a];
  for (std::size_t v = 0; v < n; ++v) {
    CHECK(sums[v] == Approx(want[v]).epsilon(1e-13));
    CHECK(matrix.lumped()[v] == Approx(want[v]).epsilon(1e-13));
  }
  // Rayleigh quotients x·Mx / x·Dx of random vectors and of power iterations for both ends.
  double low = INFINITY, high = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> x(n), y(n);
    for (double& value : x) value = uniform(random) - 0.5;
    for (int step = 0; step < 30; ++step) {
      matrix.multiply(x, 1, y);
      double top = 0, bottom = 0, largest = 0;
      for (std::size_t v = 0; v < n; ++v) {
        const double inverse = matrix.inverse_diagonal()[v];
        if (inverse == 0) continue;
        top += x[v] * y[v];
        bottom += x[v] * x[v] / inverse;
        const double image = inverse * y[v];
        x[v] = trial % 2 == 0 ? image : 2.5 * x[v] - image;
        largest = std::max(largest, std::abs(x[v]));
      }
      low = std::min(low, top / bottom);
      high = std::max(high, top / bottom);
      for (double& value : x) value /= largest;
    }
  }
  CAPTURE(low, high);
  CHECK(low >= 0.5 - 1e-12);
  CHECK(high <= 2.5 + 1e-12);
  CHECK(low < 0.7);
  CHECK(high > 1.5);
}
