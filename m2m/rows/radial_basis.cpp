// The only source that includes Eigen, whose headers take seconds to compile.
#include "m2m/radial_basis.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace tess::m2m {
namespace {

using Matrix = Eigen::MatrixXd;
using Stride = Eigen::OuterStride<>;
using Eigen::Index;

constexpr std::size_t n_terms = 4;  // of a linear polynomial
/// A direction whose extent is smaller than this part of the largest one is none.
constexpr double least_extent = 1e-10;
/// Below this reciprocal condition fewer than four digits of the values may be right.
constexpr double least_condition = 1e-12;

/// Applies the reflector I - 2 v vᵀ.
void reflect(std::span<const double> v, std::span<double> x) {
  const double twice = 2 * std::inner_product(v.begin(), v.end(), x.begin(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] -= twice * v[i];
}

double norm_of(std::span<const double> v) {
  return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0));
}

void check_points(std::span<const Point> points, const RadialBasisOptions& options) {
  if (options.kernel == RadialKernel::wendland && !(options.radius > 0 && options.radius <= 1e100))
    fail(ErrorCode::bad_argument, "radial basis: the radius ", options.radius,
         " of kernel wendland is not positive; choose several distances between neighbours");
  const std::size_t n = points.size();
  if (n < n_terms)
    fail(ErrorCode::bad_mesh, "radial basis: ", n,
         " points determine no linear polynomial; give at least 4 that are not in a plane");
  if (n > RadialBasis::most_points)
    fail(ErrorCode::bad_mesh, "radial basis: ", n, " points need a matrix of ",
         static_cast<double>(n) * static_cast<double>(n) * 8e-9, " GB, and at most ",
         RadialBasis::most_points, " points are taken; choose a coarser source, or kind ",
         "moving-least-squares");
  for (std::size_t i = 0; i < n; ++i)
    for (const double x : points[i])
      if (!(std::abs(x) <= 1e100))
        fail(ErrorCode::bad_mesh, "radial basis: point ", i, " has the coordinate ", x,
             "; coordinates must be finite and at most 1e100");
}

}  // namespace

struct RadialBasis::System {
  RadialBasisOptions options;
  Point origin{};
  double unit = 1;              // the longest side of the points' box
  std::vector<Point> places{};  // the points in the unit box
  /// Q of the polynomial's terms at the points, as reflectors (Householder 1958), and R, in whose
  /// columns only the first four rows count.
  std::array<std::vector<double>, n_terms> reflectors{}, r{};
  /// Qᵀ A Q by columns. Its first four rows count from the fourth column on; below them is the
  /// factor of Cholesky.
  std::vector<double> matrix{};

  System(std::span<const Point> points, const RadialBasisOptions& all) : options(all) {
    const Aabb box = collide::box_around(points);
    origin = box.lo;
    const Point sides = difference(box.hi, box.lo);
    if (const double longest = std::ranges::max(sides); longest > 0) unit = longest;
    for (const Point& p : points) places.push_back(place_of(p));
  }
  [[nodiscard]] std::size_t size() const { return places.size(); }
  [[nodiscard]] std::span<double> column(std::size_t j) {
    return std::span(matrix).subspan(j * size(), size());
  }
  [[nodiscard]] Point place_of(const Point& p) const {
    return {(p[0] - origin[0]) / unit, (p[1] - origin[1]) / unit, (p[2] - origin[2]) / unit};
  }
  [[nodiscard]] double kernel(const Point& p, const Point& q) const {
    const Point d = difference(p, q);
    const double squared = dot(d, d);
    if (options.kernel == RadialKernel::thin_plate)
      return squared == 0 ? 0 : 0.5 * squared * std::log(squared);
    const double s = std::sqrt(squared) * unit / options.radius;
    return s < 1 ? (1 - s) * (1 - s) * (1 - s) * (1 - s) * (4 * s + 1) : 0;
  }
  void reduce();
  [[nodiscard]] double factor();
  [[nodiscard]] std::array<double, n_terms> solve(std::span<double> c) const;
};

/// Makes Q and R. Their columns show in how many directions the points have an extent.
void RadialBasis::System::reduce() {
  std::size_t rank = 0;
  for (std::size_t k = 0; k < n_terms; ++k) {
    for (const Point& p : places) r[k].push_back(k == 0 ? 1 : p[k - 1]);
    for (std::size_t before = 0; before < k; ++before) reflect(reflectors[before], r[k]);
    std::vector<double>& v = reflectors[k] = r[k];
    std::fill_n(v.begin(), k, 0.0);
    const double norm = norm_of(v);
    if (norm > least_extent * std::abs(r[0][0])) ++rank;
    v[k] += v[k] > 0 ? norm : -norm;
    if (const double length = norm_of(v); length > 0)
      for (double& x : v) x /= length;
    reflect(v, r[k]);
  }
  if (rank < n_terms)
    fail(ErrorCode::bad_mesh, "radial basis: the ", size(), " points lie ",
         rank == 3 ? "in a plane" : "on a line",
         ", and determine no linear polynomial; add points off it, or choose kind projection or "
         "moving-least-squares");
}

/// From A to Qᵀ A Q, and its factor. Returns the reciprocal condition.
double RadialBasis::System::factor() {
  const std::size_t n = size();
  for (const std::vector<double>& v : reflectors) {
    std::vector<double> w;  // 2 (A v - (vᵀ A v) v)
    for (std::size_t j = 0; j < n; ++j)
      w.push_back(2 * std::inner_product(v.begin(), v.end(), column(j).begin(), 0.0));
    const double both = std::inner_product(v.begin(), v.end(), w.begin(), 0.0);
    for (std::size_t i = 0; i < n; ++i) w[i] -= both * v[i];
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) column(j)[i] -= v[i] * w[j] + w[i] * v[j];
  }
  if (n == n_terms) return 1;
  const auto m = static_cast<Index>(n - n_terms);
  Eigen::Map<Matrix, 0, Stride> map(&matrix[n_terms * (n + 1)], m, m, Stride(m + 4));
  Eigen::Ref<Matrix, 0, Stride> block = map;
  const Eigen::LLT<Eigen::Ref<Matrix, 0, Stride>> cholesky(block);
  return cholesky.info() == Eigen::Success ? cholesky.rcond() : 0;
}

/// From values to the c of one component. Returns its polynomial.
std::array<double, n_terms> RadialBasis::System::solve(std::span<double> c) const {
  const std::size_t n = size();
  for (const std::vector<double>& v : reflectors) reflect(v, c);
  const auto m = static_cast<Index>(n - n_terms);
  Eigen::Map<Eigen::VectorXd> right(c.data() + n_terms, m);
  const Eigen::Map<const Matrix, 0, Stride> map(matrix.data() + n_terms * (n + 1), m, m,
                                                Stride(m + 4));
  map.triangularView<Eigen::Lower>().solveInPlace(right);
  map.triangularView<Eigen::Lower>().adjoint().solveInPlace(right);
  std::array<double, n_terms> p{};
  for (std::size_t t = n_terms; t-- > 0;) {  // the first rows: R p = values - A c
    for (std::size_t j = n_terms; j < n; ++j) c[t] -= matrix[j * n + t] * c[j];
    for (std::size_t u = t + 1; u < n_terms; ++u) c[t] -= r[u][t] * p[u];
    p[t] = c[t] / r[t][t];
  }
  std::fill_n(c.begin(), n_terms, 0.0);
  for (std::size_t t = n_terms; t-- > 0;) reflect(reflectors[t], c);
  return p;
}

RadialBasis::RadialBasis(std::span<const Point> points, const RadialBasisOptions& options) {
  check_points(points, options);
  system_ = std::make_unique<System>(points, options);
  System& system = *system_;
  const std::size_t n = system.size();
  system.matrix.resize(n * n);
  double least = std::numeric_limits<double>::infinity();
  std::size_t first = 0, second = 0;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i <= j; ++i) {
      const Point d = difference(points[i], points[j]);
      if (i != j && dot(d, d) < least) least = dot(d, d), first = i, second = j;
      system.column(j)[i] = system.column(i)[j] = system.kernel(system.places[i], system.places[j]);
    }
  if (least > 0) system.reduce();
  if (!(least > 0) || !(system.factor() > least_condition))
    fail(ErrorCode::bad_mesh, "radial basis: points ", first, " and ", second,
         ", the nearest two, have the distance ", std::sqrt(least),
         ", so that the system is singular or ill-conditioned; merge such points",
         options.kernel == RadialKernel::thin_plate ? "" : ", or choose a smaller radius");
}
RadialBasis::RadialBasis(RadialBasis&& other) noexcept = default;
RadialBasis& RadialBasis::operator=(RadialBasis&& other) noexcept = default;
RadialBasis::~RadialBasis() = default;

std::vector<double> RadialBasis::values(std::span<const double> source_values,
                                        std::size_t n_components,
                                        std::span<const Point> targets) const {
  const std::size_t n = system_->size();
  TESS_CHECK(source_values.size() == n * n_components, "expected ", n * n_components,
             " values, got ", source_values.size());
  std::vector<double> out(targets.size() * n_components), c(n);
  for (std::size_t k = 0; k < n_components; ++k) {
    for (std::size_t i = 0; i < n; ++i) c[i] = source_values[i * n_components + k];
    const std::array<double, n_terms> p = system_->solve(c);
    for (std::size_t t = 0; t < targets.size(); ++t) {
      const Point at = system_->place_of(targets[t]);
      double& sum = out[t * n_components + k];
      sum = p[0] + p[1] * at[0] + p[2] * at[1] + p[3] * at[2];
      for (std::size_t i = 0; i < n; ++i) sum += c[i] * system_->kernel(at, system_->places[i]);
    }
  }
  return out;
}

}  // namespace tess::m2m
