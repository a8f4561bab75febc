// Linear functions in elements, given at the corners of their tetrahedra: exact for linear fields,
// and limited to what a loop over all elements finds around.
#include "m2m/rows/reconstruct/element_corners.hpp"

#include "apps/kit/worst.hpp"
#include "runtime/core/hash.hpp"
#include "tests/m2m/element_meshes.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

using namespace tess::m2m;
using tess::test::all_element_types, tess::test::ball, tess::test::element_mesh,
    tess::test::linear_at, tess::test::Values;

namespace {

/// A mesh whose elements were split, with ids. Vertices are moved, so that the tetrahedra of an
/// element differ in volume.
struct Elements {
  TetMesh mesh;
  std::vector<GlobalId> of_tet, tet_ids;

  explicit Elements(TetMesh of) : mesh(std::move(of)) {
    tet_ids.resize(mesh.n_tets());
    std::iota(tet_ids.begin(), tet_ids.end(), 0);
    of_tet = mesh.element_of_tet.empty() ? tet_ids : mesh.element_of_tet;
  }
  explicit Elements(ElementType type) : Elements(moved(element_mesh(type, 4))) {}

  static TetMesh moved(TetMesh mesh) {
    tess::Random random(3);
    for (Point& p : mesh.points)
      for (double& x : p) x += 0.04 * (random.unit() - 0.5);
    return mesh;
  }
  /// The mean of the values at the tetrahedra's centroids over the volume, in all tetrahedra.
  [[nodiscard]] Values means(const std::function<double(const Point&)>& f) const {
    std::map<GlobalId, std::array<double, 2>> sums;
    for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
      std::array<Point, 4> corners;
      for (std::size_t k = 0; k < 4; ++k)
        corners[k] = mesh.points[static_cast<std::size_t>(mesh.tets[t][k])];
      const double volume = std::abs(signed_volume(corners));
      sums[of_tet[t]][0] += volume * f(mean_of_corners(corners));
      sums[of_tet[t]][1] += volume;
    }
    Values values;
    for (const GlobalId element : of_tet) values.push_back(sums[element][0] / sums[element][1]);
    return values;
  }
  [[nodiscard]] Values corners(const Values& values, CornerLimit limit) const {
    return element_corners({mesh.points, mesh.tets, {}, tet_ids}, of_tet, values, 1, limit);
  }
};

}  // namespace

TEST_CASE("a linear field has its own values at the corners of all types of elements",
          "[m2m][reconstruct]") {
  for (const ElementType type : all_element_types) {
    const Elements elements(type);
    INFO(elements.mesh.name);
    const Values got = elements.corners(elements.means(linear_at), CornerLimit::none);
    double error = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      const VertexId v = elements.mesh.tets[i / 4][i % 4];
      const double want = linear_at(elements.mesh.points[static_cast<std::size_t>(v)]);
      kit::worsen(error, std::abs(got[i] - want));
    }
    CHECK(error < 1e-12);
    // The same values in meshes whose volumes times lengths leave the range of double.
    const Values values = elements.means(linear_at);
    for (const int exponent : {-260, 300}) {
      Elements scaled = elements;
      for (Point& p : scaled.mesh.points)
        for (double& x : p) x = std::ldexp(x, exponent);
      const Values there = scaled.corners(values, CornerLimit::none);
      double change = 0;
      for (std::size_t i = 0; i < got.size(); ++i) kit::worsen(change, std::abs(there[i] - got[i]));
      CHECK(change < 1e-12);
      CHECK(std::ranges::none_of(there, [](double x) { return std::isnan(x); }));
    }
  }
}

TEST_CASE("a single layer of elements, flat up to rounding or curved, has values near the field's",
          "[m2m][reconstruct]") {
  for (const auto& layer : tess::test::layers) {
    INFO(layer.name);
    const Elements elements(tess::test::layer_mesh(20, layer.place));
    const auto wave = [&](const Point& p) { return tess::test::wave_at(p, layer.origin); };
    for (const CornerLimit limit : {CornerLimit::none, CornerLimit::neighbours}) {
      const Values got = elements.corners(elements.means(wave), limit);
      double error = 0;
      for (std::size_t i = 0; i < got.size(); ++i) {
        const VertexId v = elements.mesh.tets[i / 4][i % 4];
        kit::worsen(error,
                    std::abs(got[i] - wave(elements.mesh.points[static_cast<std::size_t>(v)])));
      }
      CHECK(error < (limit == CornerLimit::none ? 0.1 : 0.2));
    }
  }
}

TEST_CASE("limited values at an element's corners lie within those of the elements around",
          "[m2m][reconstruct]") {
  for (const ElementType type : all_element_types) {
    const Elements elements(type);
    INFO(elements.mesh.name);
    const Values values = elements.means(ball);
    std::map<VertexId, std::set<double>> at_vertex;
    std::map<GlobalId, std::set<VertexId>> of_element;
    for (std::size_t t = 0; t < elements.mesh.n_tets(); ++t)
      for (const VertexId v : elements.mesh.tets[t]) {
        at_vertex[v].insert(values[t]);
        of_element[elements.of_tet[t]].insert(v);
      }
    const Values free = elements.corners(values, CornerLimit::none);
    const Values got = elements.corners(values, CornerLimit::neighbours);
    std::size_t n_below = 0, n_above = 0, n_free_below = 0, n_free_above = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      double low = 1, high = 0;
      for (const VertexId v : of_element[elements.of_tet[i / 4]]) {
        low = std::min(low, *at_vertex[v].begin());
        high = std::max(high, *at_vertex[v].rbegin());
      }
      n_below += got[i] < low - 1e-14 ? 1U : 0U;
      n_above += got[i] > high + 1e-14 ? 1U : 0U;
      n_free_below += free[i] < low - 0.01 ? 1U : 0U;
      n_free_above += free[i] > high + 0.01 ? 1U : 0U;
    }
    CHECK(n_below == 0);
    CHECK(n_above == 0);
    CHECK(n_free_below > 0);
    CHECK(n_free_above > 0);
  }
}
