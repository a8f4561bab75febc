// Meshes of a box made of one type of element each, as the readers split them.
#pragma once

#include "m2m/io/elements/split_element.hpp"
#include "m2m/mesh.hpp"
#include "m2m/rows/interpolate/native_element.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <vector>

namespace tess::test {

inline constexpr std::array all_element_types{m2m::ElementType::tet4, m2m::ElementType::tet10,
                                              m2m::ElementType::hex8, m2m::ElementType::wedge6,
                                              m2m::ElementType::pyramid5};

/// Those that are split.
inline constexpr std::array native_element_types{m2m::ElementType::hex8, m2m::ElementType::wedge6,
                                                 m2m::ElementType::pyramid5,
                                                 m2m::ElementType::tet10, m2m::ElementType::hex27};

/// The unit cube of n³ bricks whose sides grow along each axis, so that ten-node tetrahedra are
/// curved: n³ hexahedra, or 6 n³ tetrahedra, 2 n³ wedges or 6 n³ pyramids.
inline m2m::TetMesh element_mesh(m2m::ElementType type, int n) {
  using m2m::ElementType;
  using Grid = std::array<int, 3>;  // in half bricks
  m2m::TetMesh mesh;
  mesh.name = m2m::name_of(type);
  m2m::ElementSplitter splitter(mesh);
  std::map<Grid, m2m::VertexId> known;
  const auto vertex = [&](const Grid& at) {
    const auto [entry, is_new] = known.try_emplace(at, static_cast<m2m::VertexId>(known.size()));
    if (is_new) {
      m2m::Point p;
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = at[k] / (2.0 * n);
        p[k] = x + 0.15 * x * (1 - x);
      }
      mesh.points.push_back(p);
    }
    return entry->second;
  };
  const auto add = [&](const std::vector<Grid>& nodes) {
    std::vector<m2m::VertexId> vertices;
    for (const Grid& at : nodes) vertices.push_back(vertex(at));
    splitter.add(type, vertices);
  };
  const auto middle = [](const Grid& a, const Grid& b) {
    return Grid{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
  };
  for (int i = 0; i < 2 * n; i += 2)
    for (int j = 0; j < 2 * n; j += 2)
      for (int k = 0; k < 2 * n; k += 2) {
        const std::array<Grid, 8> v{{{i, j, k},
                                     {i + 2, j, k},
                                     {i + 2, j + 2, k},
                                     {i, j + 2, k},
                                     {i, j, k + 2},
                                     {i + 2, j, k + 2},
                                     {i + 2, j + 2, k + 2},
                                     {i, j + 2, k + 2}}};
        if (type == ElementType::hex27) {
          std::vector<Grid> nodes;
          for (std::size_t node = 0; node < 27; ++node) {
            const m2m::Point r = m2m::reference_vertex(27, node);
            nodes.push_back({i + int(2 * r[0]), j + int(2 * r[1]), k + int(2 * r[2])});
          }
          add(nodes);
        } else if (type == ElementType::hex8) {
          add({v.begin(), v.end()});
        } else if (type == ElementType::wedge6) {
          add({v[0], v[1], v[2], v[4], v[5], v[6]});
          add({v[0], v[2], v[3], v[4], v[6], v[7]});
        } else if (type == ElementType::pyramid5) {
          constexpr std::size_t faces[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                               {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
          for (const auto& f : faces)
            add({v[f[0]], v[f[1]], v[f[2]], v[f[3]], {i + 1, j + 1, k + 1}});
        } else {
          constexpr std::size_t corners[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                                 {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
          for (const auto& c : corners) {
            std::vector<Grid> nodes{v[c[0]], v[c[1]], v[c[2]], v[c[3]]};
            constexpr std::size_t edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
            if (type == ElementType::tet10)
              for (const auto& e : edges) nodes.push_back(middle(nodes[e[0]], nodes[e[1]]));
            add(nodes);
          }
        }
      }
  splitter.finish();
  return mesh;
}

/// Moves the inner vertices of a mesh of the unit cube by up to `amount` per axis.
inline m2m::TetMesh shaken(m2m::TetMesh mesh, double amount) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> by(-amount, amount);
  for (m2m::Point& p : mesh.points) {
    const auto is_inner = [](double x) { return x > 1e-9 && x < 1 - 1e-9; };
    if (std::ranges::all_of(p, is_inner))
      for (double& x : p) x += by(random);
  }
  return mesh;
}

/// One layer of n × n hexahedra of edge 1 / n, each vertex at `place` of where it is on the plane.
inline m2m::TetMesh layer_mesh(int n, const std::function<m2m::Point(const m2m::Point&)>& place) {
  m2m::TetMesh mesh;
  mesh.name = "layer";
  const double edge = 1.0 / n;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) mesh.points.push_back(place({i * edge, j * edge, k * edge}));
  m2m::ElementSplitter splitter(mesh);
  const m2m::VertexId row = n + 1, top = row * row;
  for (m2m::VertexId j = 0; j < n; ++j)
    for (m2m::VertexId i = 0; i < n; ++i) {
      const m2m::VertexId v = j * row + i;
      splitter.add(m2m::ElementType::hex8,
                   std::vector{v, v + 1, v + row + 1, v + row, v + top, v + top + 1,
                               v + top + row + 1, v + top + row});
    }
  splitter.finish();
  return mesh;
}
/// Turned out of the planes of the axes.
inline m2m::Point turned(const m2m::Point& p) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  const double x = c * p[0] - s * p[2], z = s * p[0] + c * p[2];
  return {x, c * p[1] - s * z, s * p[1] + c * z};
}
struct Layer {
  const char* name;
  m2m::Point origin;
  m2m::Point (*place)(const m2m::Point&);
};
/// Single layers that are flat up to rounding, or curved. A field is smooth in the distance from
/// the origin.
inline constexpr std::array layers{
    Layer{"plane", {0, 0, 0}, turned},
    Layer{"plane in float",
          {0, 0, 0},
          [](const m2m::Point& p) {
            m2m::Point q = turned(p);
            for (double& x : q) x = static_cast<float>(x);
            return q;
          }},
    Layer{"plane far away",
          {1000, 700, -300},
          [](const m2m::Point& p) {
            const m2m::Point q = turned(p);
            return m2m::Point{1000 + q[0], 700 + q[1], q[2] - 300};
          }},
    Layer{"cylinder",
          {0, 0, 0},
          [](const m2m::Point& p) {
            const double r = 10 + p[2], angle = p[0] / 10;
            return m2m::Point{r * std::sin(angle), p[1], r * std::cos(angle) - 10};
          }},
};
inline double wave_at(const m2m::Point& p, const m2m::Point& origin) {
  return std::sin(3 * (p[0] - origin[0])) + std::cos(2 * (p[1] - origin[1]));
}

/// 1 + 2x - 3y + 5z
inline double linear_at(const m2m::Point& p) {
  return 1 + 2 * p[0] - 3 * p[1] + 5 * p[2];
}

}  // namespace tess::test
