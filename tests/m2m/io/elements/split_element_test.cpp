#include "m2m/io/elements/split_element.hpp"

#include "m2m/kuhn.hpp"
#include "m2m/rows/interpolate/native_element.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <random>

using namespace tess::m2m;

namespace {

const std::vector<Point> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                              {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
const std::vector<Point> wedge{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
const std::vector<Point> pyramid{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
const std::vector<Point> tet10{{0, 0, 0},     {1, 0, 0},     {0, 1, 0},   {0, 0, 1},
                               {0.5, 0, 0},   {0.5, 0.5, 0}, {0, 0.5, 0}, {0, 0, 0.5},
                               {0.5, 0, 0.5}, {0, 0.5, 0.5}};

struct Known {
  ElementType type;
  const std::vector<Point>& points;
  std::size_t n_tets;
  double volume;
};
const std::vector<Point> hex27 = [] {
  std::vector<Point> points;
  for (std::size_t k = 0; k < 27; ++k) points.push_back(reference_vertex(27, k));
  return points;
}();
const std::array<Known, 5> all{{{ElementType::hex27, hex27, 48, 1.0},
                                {ElementType::hex8, cube, 6, 1.0},
                                {ElementType::wedge6, wedge, 3, 0.5},
                                {ElementType::pyramid5, pyramid, 2, 1.0 / 3},
                                {ElementType::tet10, tet10, 8, 1.0 / 6}}};

/// Faces of tetrahedra that only one tetrahedron has.
std::vector<std::array<VertexId, 3>> boundary(const std::vector<Tet>& tets) {
  std::map<std::array<VertexId, 3>, int> count;
  for (const Tet& tet : tets) {
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<VertexId, 3> face{tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]};
      std::sort(face.begin(), face.end());
      ++count[face];
    }
  }
  std::vector<std::array<VertexId, 3>> once;
  for (const auto& [face, n] : count) {
    REQUIRE(n <= 2);
    if (n == 1) once.push_back(face);
  }
  return once;
}

}  // namespace

TEST_CASE("an element is filled by positive tetrahedra for every numbering of its vertices",
          "[m2m][elements]") {
  std::mt19937 random(2);
  for (const Known& known : all) {
    std::vector<VertexId> ids(known.points.size());
    for (std::size_t v = 0; v < ids.size(); ++v) ids[v] = static_cast<VertexId>(v);
    for (int i = 0; i < 200; ++i) {
      std::shuffle(ids.begin(), ids.end(), random);
      TetMesh mesh;
      mesh.points.resize(ids.size());
      for (std::size_t v = 0; v < ids.size(); ++v)
        mesh.points[static_cast<std::size_t>(ids[v])] = known.points[v];
      ElementSplitter splitter(mesh);
      splitter.add(known.type, ids);
      double volume = 0;
      for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
        CHECK(signed_volume(mesh, t) > 0.01);
        volume += signed_volume(mesh, t);
      }
      CHECK(mesh.n_tets() == known.n_tets);
      CHECK(volume == Approx(known.volume).epsilon(1e-14));
      // The sides cover the boundary, each of its triangles once.
      std::vector<Side> sides;
      for (std::size_t side = 1; side <= splitter.n_sides_of(0); ++side)
        splitter.append_side(0, static_cast<std::int64_t>(side), sides);
      CHECK(sides.size() == boundary(mesh.tets).size());
      std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.tet < b.tet || (a.tet == b.tet && a.side < b.side);
      });
      CHECK(std::adjacent_find(sides.begin(), sides.end()) == sides.end());
    }
  }
}

TEST_CASE("elements that share faces split them alike", "[m2m][elements]") {
  // 27 cubes with shuffled vertices. Every third one is cut into pyramids about a new vertex.
  std::mt19937 random(7);
  const TetMesh lattice = kuhn_mesh({3});
  for (int i = 0; i < 50; ++i) {
    std::vector<VertexId> id(lattice.n_points() + 27);
    for (std::size_t v = 0; v < id.size(); ++v) id[v] = static_cast<VertexId>(v);
    std::shuffle(id.begin(), id.end(), random);
    std::vector<Tet> tets;
    std::size_t n_cubes = 0;
    for (std::size_t z = 0; z < 3; ++z)
      for (std::size_t y = 0; y < 3; ++y)
        for (std::size_t x = 0; x < 3; ++x) {
          const auto at = [&](std::size_t a, std::size_t b, std::size_t c) {
            return id[x + a + 4 * (y + b) + 16 * (z + c)];
          };
          const std::array<VertexId, 8> v{at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0),
                                          at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)};
          const VertexId centre = id[lattice.n_points() + n_cubes];
          switch (n_cubes++ % 3) {
            case 0:
              split_element(ElementType::hex8, v, tets);
              break;
            case 1:
              split_element(ElementType::pyramid5, std::array{v[0], v[1], v[2], v[3], centre},
                            tets);
              split_element(ElementType::pyramid5, std::array{v[4], v[7], v[6], v[5], centre},
                            tets);
              split_element(ElementType::pyramid5, std::array{v[0], v[4], v[5], v[1], centre},
                            tets);
              split_element(ElementType::pyramid5, std::array{v[1], v[5], v[6], v[2], centre},
                            tets);
              split_element(ElementType::pyramid5, std::array{v[2], v[6], v[7], v[3], centre},
                            tets);
              split_element(ElementType::pyramid5, std::array{v[3], v[7], v[4], v[0], centre},
                            tets);
              break;
            default:  // a cube that is written with another first vertex
              split_element(ElementType::hex8,
                            std::array{v[1], v[2], v[3], v[0], v[5], v[6], v[7], v[4]}, tets);
          }
        }
    CHECK(boundary(tets).size() == 2 * 9 * 6);  // two triangles per square of the surface
  }
}

TEST_CASE("elements with repeated vertices give the tetrahedra of what they are",
          "[m2m][elements]") {
  std::vector<Tet> tets;
  split_element(ElementType::hex8, std::array{0, 1, 2, 2, 3, 4, 5, 5}, tets);
  CHECK(tets.size() == 3);  // a wedge
  CHECK(boundary(tets).size() == 8);
  tets.clear();
  split_element(ElementType::hex8, std::array{3, 4, 5, 5, 0, 1, 2, 2}, tets);
  CHECK(tets.size() == 3);
  tets.clear();
  split_element(ElementType::hex8, std::array{0, 1, 2, 2, 3, 3, 3, 3}, tets);
  CHECK(tets.size() == 1);  // a tetrahedron
  tets.clear();
  split_element(ElementType::hex8, std::array{1, 1, 1, 1, 1, 1, 1, 1}, tets);
  CHECK(tets.empty());
}

TEST_CASE("a hexahedron whose vertices stand in the order of a voxel is folded",
          "[m2m][elements]") {
  TetMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.points.push_back({double((i ^ (i >> 1)) & 1), double((i >> 1) & 1), double(i >> 2)});
  ElementSplitter splitter(mesh);
  splitter.add(ElementType::hex8, std::array{0, 1, 2, 3, 4, 5, 6, 7});
  splitter.add(ElementType::hex8, std::array{0, 1, 3, 2, 4, 5, 7, 6});
  splitter.finish();
  CHECK(split_text(mesh) ==
        "2 HEX8 into 12 tetrahedra (1 folded, so that their parts overlap: check the order of "
        "their vertices)");
}

TEST_CASE("tetrahedra know their element, and sides their tetrahedra, in a mix of types",
          "[m2m][elements]") {
  TetMesh mesh;
  mesh.points.resize(12);
  ElementSplitter splitter(mesh);
  splitter.add(ElementType::tet4, std::array{0, 1, 2, 8});
  splitter.add(ElementType::tet4, std::array{1, 2, 8, 9});
  splitter.add(ElementType::hex8, std::array{0, 1, 2, 3, 4, 5, 6, 7});
  splitter.add(ElementType::hex8, std::array{0, 1, 1, 1, 4, 4, 4, 4});  // no volume: no tetrahedron
  splitter.add(ElementType::pyramid5, std::array{0, 1, 2, 3, 10});
  splitter.add(ElementType::hex8, std::array{0, 1, 2, 3, 4, 5, 6, 7});
  splitter.add(ElementType::tet4, std::array{1, 2, 8, 11});
  splitter.finish();
  CHECK(mesh.element_of_tet ==
        std::vector<GlobalId>{0, 1, 2, 2, 2, 2, 2, 2, 4, 4, 5, 5, 5, 5, 5, 5, 6});
  CHECK(mesh.split == std::vector<SplitElements>{{"HEX8", 3, 12}, {"PYRAMID5", 1, 2}});
  CHECK(split_text(mesh) == "3 HEX8 into 12 tetrahedra, 1 PYRAMID5 into 2 tetrahedra");
  CHECK(splitter.n_sides_of(0) == 4);
  CHECK(splitter.n_sides_of(3) == 6);
  CHECK(splitter.n_sides_of(7) == 0);
  const auto n_faces = [&](GlobalId element, std::int64_t side) {
    std::vector<Side> sides;
    splitter.append_side(element, side, sides);
    for (const Side& s : sides)
      CHECK(mesh.element_of_tet[static_cast<std::size_t>(s.tet)] == element);
    return sides.size();
  };
  CHECK(n_faces(1, 4) == 1);
  CHECK(n_faces(2, 6) == 2);
  CHECK(n_faces(3, 1) == 0);
  CHECK(n_faces(4, 1) == 1);
  CHECK(n_faces(4, 5) == 2);
  CHECK(n_faces(5, 1) == 2);
  CHECK(n_faces(6, 2) == 1);
  TetMesh plain;
  plain.points.resize(4);
  ElementSplitter tets(plain);
  tets.add(ElementType::tet4, std::array{0, 1, 2, 3});
  tets.finish();
  CHECK(plain.element_of_tet.empty());
  CHECK(split_text(plain).empty());
}
