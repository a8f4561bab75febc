#include "m2m/rows/supermesh/moments.hpp"

#include "m2m/kuhn.hpp"
#include "m2m/rigid_motion.hpp"
#include "m2m/rows/interpolate/orientation.hpp"
#include "tests/m2m/overlapping.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iostream>
#include <random>

using namespace tess::m2m;
using tess::test::overlapping_pairs, tess::test::TetPair, tess::test::view;

namespace {

const Corners corner_tet{Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};

double volume_of(const Corners& c) {
  TetMesh mesh{{}, {c.begin(), c.end()}, {{0, 1, 2, 3}}};
  return std::abs(signed_volume(mesh, 0));
}

Corners moved(Corners c, double factor, const Point& shift) {
  for (Point& p : c)
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = p[axis] * factor + shift[axis];
  return c;
}

class RandomTets {
 public:
  explicit RandomTets(unsigned seed) : random_(seed) {}
  Corners next(double flatness = 1) {
    Corners c;
    for (Point& p : c) {
      const double u = uniform_(random_), v = uniform_(random_), w = flatness * uniform_(random_);
      p = {u + w, v - w, 0.4 * u - 0.7 * v + w};
    }
    return c;
  }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{0, 1};
};

double total(const Matrix4& m) {
  double sum = 0;
  for (const Weights& row : m)
    for (const double x : row) sum += x;
  return sum;
}

}  // namespace

TEST_CASE("overlaps of simple pairs have the volumes of closed forms", "[m2m][supermesh]") {
  CHECK(overlap_volume(corner_tet, corner_tet) == 1.0 / 6);
  // A smaller copy at the corner, inside, and shifted by s along x: a copy of edge 1 - s.
  CHECK(overlap_volume(corner_tet, moved(corner_tet, 0.5, {})) == Approx(1.0 / 48).epsilon(1e-15));
  CHECK(overlap_volume(corner_tet, moved(corner_tet, 0.25, {0.1, 0.1, 0.1})) ==
        Approx(1.0 / 384).epsilon(1e-15));
  for (const double s : {1e-12, 1e-6, 0.1, 0.5, 0.9, 0.999}) {
    const double edge = 1 - s;
    CHECK(overlap_volume(corner_tet, moved(corner_tet, 1, {s, 0, 0})) ==
          Approx(edge * edge * edge / 6).epsilon(1e-13));
  }
  // The tetrahedron and its image in the point (1/4, 1/4, 1/4): opposite faces of an octahedron in
  // a regular pair; here the volume by inclusion and exclusion of four corners of edge 1/2.
  const Corners image = moved(corner_tet, -1, {0.5, 0.5, 0.5});
  // Both hold x, y, z >= 0, x, y, z <= 1/2, and x + y + z between 1/2 and 1.
  CHECK(overlap_volume(corner_tet, image) == Approx(1.0 / 8 - 1.0 / 48 - 1.0 / 48).epsilon(1e-14));
}

TEST_CASE("tetrahedra that only touch have no volume in common", "[m2m][supermesh]") {
  CHECK(overlap_volume(corner_tet, moved(corner_tet, 1, {1, 0, 0})) == 0);   // a vertex
  CHECK(overlap_volume(corner_tet, moved(corner_tet, -1, {})) == 0);         // a vertex
  CHECK(overlap_volume(corner_tet, moved(corner_tet, -1, {1, 0, 0})) == 0);  // an edge
  Corners mirror = corner_tet;
  mirror[3][2] = -1;
  CHECK(overlap_volume(corner_tet, mirror) == 0);  // a face
  CHECK(overlap_volume(corner_tet, moved(corner_tet, 1, {5, 5, 5})) == 0);
  Corners flat = corner_tet;
  flat[3] = {0.3, 0.3, 0};
  CHECK(overlap_volume(corner_tet, flat) == 0);
  CHECK(overlap_volume(flat, corner_tet) == 0);
  CHECK(overlap_volume(flat, flat) == 0);
  const PairMoments none = pair_moments(corner_tet, mirror);
  CHECK(none.volume == 0);
  CHECK(total(none.mixed) == 0);
}

TEST_CASE("every permutation of the corners and either order of the pair give the same volume",
          "[m2m][supermesh]") {
  RandomTets random(3);
  for (int i = 0; i < 50; ++i) {
    const Corners a = random.next(), b = random.next();
    const double want = overlap_volume(a, b), scale = std::min(volume_of(a), volume_of(b));
    CHECK(std::abs(overlap_volume(b, a) - want) <= 1e-14 * scale);
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    do {
      const Corners c{a[order[0]], a[order[1]], a[order[2]], a[order[3]]};
      CHECK(std::abs(overlap_volume(c, b) - want) <= 1e-14 * scale);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST_CASE("overlaps with the parts of a partition of space add up to 1e-13", "[m2m][supermesh]") {
  // Random tetrahedra of every flatness within the cube, against jittered meshes of the cube.
  for (const std::int32_t n : {1, 3, 6}) {
    const TetMesh mesh = kuhn_mesh({n, n > 1 ? 0.2 : 0.0});
    for (const double flatness : {1.0, 1e-3, 1e-6, 1e-10}) {
      RandomTets random(static_cast<unsigned>(n));
      for (int i = 0; i < 20; ++i) {
        const Corners tet = moved(random.next(flatness), 0.3, {0.2, 0.3, 0.35});
        double sum = 0, mixed = 0;
        for (const Tet& t : mesh.tets) {
          const PairMoments m = pair_moments(tet, corners_of(mesh.points, t));
          sum += m.volume;
          mixed += total(m.mixed);
          if (m.volume != overlap_volume(tet, corners_of(mesh.points, t))) FAIL("two volumes");
        }
        CAPTURE(n, flatness, i);
        CHECK(std::abs(sum / volume_of(tet) - 1) < 1e-13);
        CHECK(std::abs(mixed / volume_of(tet) - 1) < 1e-13);
      }
    }
  }
}

TEST_CASE("two meshes of a cube overlap in its volume, and slivers lose nothing",
          "[m2m][supermesh]") {
  // Layers of aspect up to 1e6: the second mesh is squeezed towards z = 0. Half of the cubes are
  // turned, so that faces in one plane are so up to rounding.
  for (const double power : {1.0, 4.0, 8.0, -1.0, -4.0}) {
    TetMesh a = kuhn_mesh({4, 0.2}), b = kuhn_mesh({6, 0.1});
    for (Point& p : b.points) p[2] = std::pow(p[2], std::abs(power));
    if (power < 0)
      for (TetMesh* mesh : {&a, &b}) move_points(mesh->points, {.axis = {1, 2, 3}, .angle = 0.7});
    double sum = 0;
    for (const TetPair& pair : overlapping_pairs(view(a), view(b)))
      sum += overlap_volume(corners_of(a.points, a.tets[static_cast<std::size_t>(pair.source)]),
                            corners_of(b.points, b.tets[static_cast<std::size_t>(pair.target)]));
    CAPTURE(power);
    CHECK(std::abs(sum - 1) < 1e-13);
  }
}

TEST_CASE("a face separates only what has no volume in common, and heights are as exact as stated",
          "[m2m][supermesh]") {
  // Every second pair touches in the plane of a face, up to rounding.
  RandomTets random(6);
  std::size_t n_apart = 0;
  for (int i = 0; i < 4000; ++i) {
    const double flatness = std::pow(10.0, -(i % 7));
    Corners a = random.next(flatness), b = moved(random.next(flatness), 1, {0, 0.4 * (i % 3), 0});
    if (i % 2 == 0)
      b = moved(a, i % 4 == 0 ? -1 : -0.3, {}), b = moved(b, 1, difference(a[1], b[1]));
    for (Corners* c : {&a, &b}) *c = moved(*c, 1, {i % 5 == 0 ? 1e4 / 3 : 0, 0, 0});
    if (i % 3 == 0) std::swap(a[0], a[1]);
    const TetPlanes s(a), t(b);
    bool none_above = false;
    for (const auto& [of, by] : {std::pair(&t, &s), std::pair(&s, &t)}) {
      const Corners p = of->corners(), c = by->corners();
      for (std::size_t f = 0; f < 4; ++f) {
        bool any = false;
        for (std::size_t v = 0; v < 4; ++v) {
          const double volume = orientation_exact(p[v], c[faces_of_tet[f][0]],
                                                  c[faces_of_tet[f][1]], c[faces_of_tet[f][2]]);
          const double exact = by->sixfold < 0 ? -volume : volume;
          any = any || exact > 0;
          const bool overlap =
              tess::collide::overlap(tess::collide::box_around(a), tess::collide::box_around(b),
                                     tess::collide::Touching::counts);
          if (overlap && !(std::abs(heights(*by, *of)[f][v] - exact) <= sure_height(*by, *of)))
            FAIL(i);
        }
        none_above = none_above || !any;
      }
    }
    PairCutter pairs;
    pairs.add(s, t, 0);
    const bool apart = pairs.size() == 0;
    n_apart += apart ? 1U : 0U;
    if (apart && !none_above) FAIL("apart " << i);
    if (none_above && overlap_volume(a, b) != 0) FAIL("a volume " << i);
  }
  CHECK(n_apart > 500);
}

TEST_CASE("a mesh against itself gives each tetrahedron its own volume", "[m2m][supermesh]") {
  const TetMesh mesh = kuhn_mesh({3, 0.2});
  for (std::size_t s = 0; s < mesh.n_tets(); ++s) {
    for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
      const double overlap = overlap_volume(corners_of(mesh.points, mesh.tets[s]),
                                            corners_of(mesh.points, mesh.tets[t]));
      const double want = s == t ? signed_volume(mesh, s) : 0;
      if (!(std::abs(overlap - want) <= 1e-15 * want)) FAIL(s << " " << t << ": " << overlap);
    }
  }
}

TEST_CASE("moments integrate products of linear functions exactly", "[m2m][supermesh]") {
  // On a tetrahedron inside another one: integrals of products from a rule that is exact for them
  // (Keast 1986: four points of degree 2).
  RandomTets random(9);
  const double far = 0.5854101966249685, near = 0.1381966011250105;
  for (int i = 0; i < 100; ++i) {
    const Corners large = moved(corner_tet, 8, {-1.5, -1.5, -1.5}), small = random.next();
    if (volume_of(small) < 1e-3) continue;  // the points of the rule are rounded
    for (const bool swap : {false, true}) {
      const Corners &source = swap ? small : large, &target = swap ? large : small;
      const PairMoments moments = pair_moments(source, target);
      const double volume = volume_of(small);
      CHECK(moments.volume == Approx(volume).epsilon(1e-14));
      Matrix4 mixed{};
      for (std::size_t q = 0; q < 4; ++q) {
        Point p{};
        for (std::size_t k = 0; k < 4; ++k)
          for (std::size_t axis = 0; axis < 3; ++axis)
            p[axis] += (k == q ? far : near) * small[k][axis];
        const auto s = locate(p, source), t = locate(p, target);
        REQUIRE(s);
        REQUIRE(t);
        for (std::size_t a = 0; a < 4; ++a)
          for (std::size_t b = 0; b < 4; ++b)
            mixed[a][b] += volume / 4 * s->weights[a] * t->weights[b];
      }
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b)
          CHECK(std::abs(moments.mixed[a][b] - mixed[a][b]) < 1e-13 * volume);
    }
  }
}

TEST_CASE("a sliver that cuts has integrals between zero and the volume", "[m2m][supermesh]") {
  // A small tetrahedron near the middle of a sliver. If it is inside, the weights of the sliver at
  // its corners are quotients of volumes, and give the integrals.
  RandomTets random(11);
  std::size_t n_inside = 0;
  for (const double flatness : {1e-6, 1e-8, 1e-10, 1e-13, 1e-15, 1e-16})
    for (int i = 0; i < 300; ++i) {
      const Corners sliver = random.next(flatness);
      Point middle{};
      for (const Point& p : sliver)
        for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] += p[axis] / 4;
      Corners small = random.next(flatness);
      for (Point& p : small)
        for (std::size_t axis = 0; axis < 3; ++axis)
          p[axis] = middle[axis] + 0.01 * (p[axis] - sliver[0][axis]);
      CAPTURE(flatness, i);
      const PairMoments moments = pair_moments(sliver, small);
      if (!(std::abs(total(moments.mixed) - moments.volume) <= 1e-13 * moments.volume))
        FAIL("total");
      for (const Weights& row : moments.mixed)
        for (const double x : row)
          if (!(x >= 0 && x <= moments.volume * (1 + 1e-12))) FAIL(x << " of " << moments.volume);

      const auto exact = [](const Corners& c) { return orientation_exact(c[0], c[1], c[2], c[3]); };
      const double all = exact(sliver);
      const double volume = std::abs(orientation(small[0], small[1], small[2], small[3])) / 6;
      Matrix4 weights{};  // [corner of the sliver][corner of the small one]
      bool inside = all != 0 && volume > 0;
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b) {
          Corners part = sliver;
          part[a] = small[b];
          weights[a][b] = exact(part) / all;
          inside = inside && weights[a][b] >= 0;
        }
      if (!inside) continue;
      ++n_inside;
      if (!(std::abs(moments.volume - volume) <= 1e-13 * volume)) FAIL("volume");
      for (std::size_t a = 0; a < 4; ++a) {
        const Weights& w = weights[a];
        for (std::size_t b = 0; b < 4; ++b) {
          const double want = volume / 20 * (w[b] + (w[0] + w[1]) + (w[2] + w[3]));
          if (!(std::abs(moments.mixed[a][b] - want) <= 1e-13 * volume))
            FAIL(moments.mixed[a][b] << " in place of " << want);
        }
      }
    }
  CHECK(n_inside > 100);
}

TEST_CASE("overlaps follow the scale of the meshes, from 1e-80 to 1e90, and their place",
          "[m2m][supermesh]") {
  RandomTets random(4);
  for (int i = 0; i < 20; ++i) {
    const Corners a = random.next(), b = random.next();
    const double want = overlap_volume(a, b);
    for (const int power : {-265, -30, 30, 299}) {  // powers of two change no bit
      const double factor = std::ldexp(1.0, power);
      CHECK(overlap_volume(moved(a, factor, {}), moved(b, factor, {})) ==
            want * factor * factor * factor);
    }
    // Rounding to 2^-20 makes shifted coordinates exact; then an offset changes no bit.
    const auto rounded = [](Corners c) {
      for (Point& p : c)
        for (double& x : p) x = std::round(x * 0x1p20) * 0x1p-20;
      return c;
    };
    const Corners c = rounded(a), d = rounded(b);
    const Point shift{1e9, -3e9, 2e9};
    CHECK(overlap_volume(moved(c, 1, shift), moved(d, 1, shift)) == overlap_volume(c, d));
  }
}

TEST_CASE("time per pair of tetrahedra", "[.][benchmark][supermesh]") {
  const TetMesh a = kuhn_mesh({20, 0.2}), b = kuhn_mesh({21, 0.2});
  const auto pairs = overlapping_pairs(view(a), view(b));
  for (int repeat = 0; repeat < 3; ++repeat) {
    const auto time = [&](auto&& visit) {
      const std::clock_t start = std::clock();
      for (const TetPair& pair : pairs)
        visit(corners_of(a.points, a.tets[static_cast<std::size_t>(pair.source)]),
              corners_of(b.points, b.tets[static_cast<std::size_t>(pair.target)]));
      return 1e9 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC /
             static_cast<double>(pairs.size());
    };
    double sum = 0, mixed = 0;
    std::size_t n_overlaps = 0;
    const double plain = time([&](const Corners& s, const Corners& t) {
      const double volume = overlap_volume(s, t);
      sum += volume;
      n_overlaps += volume > 0;
    });
    const double all =
        time([&](const Corners& s, const Corners& t) { mixed += pair_moments(s, t).mixed[0][0]; });
    CHECK(std::abs(sum - 1) < 1e-12);
    std::cout << pairs.size() << " pairs, " << n_overlaps << " overlap: " << plain
              << " ns per pair for the volume, " << all << " ns for the moments ("
              << all * static_cast<double>(pairs.size()) / static_cast<double>(n_overlaps)
              << " ns per pair that overlaps), " << mixed << "\n";
  }
}
