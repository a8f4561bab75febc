#include "apps/m2m_transfer/stability/cases.hpp"
#include "m2m/kuhn.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace m2m_transfer::stability {
namespace {

/// A number in [0, 1) that depends on its arguments only.
double chance(std::uint64_t seed, std::uint64_t k) {
  return unit(mix((seed << 40U) + k * 0x9e3779b97f4a7c15U + 1));
}

const Point& corner(const TetMesh& mesh, std::size_t tet, std::size_t k) {
  return mesh.points[static_cast<std::size_t>(mesh.tets[tet][k])];
}

VertexId id_of(std::size_t vertex) {
  return static_cast<VertexId>(vertex);
}

}  // namespace

TetMesh mapped(TetMesh mesh, const std::function<Point(const Point&)>& map) {
  for (Point& p : mesh.points) p = map(p);
  return mesh;
}

TetMesh changed(TetMesh mesh, double scale, double offset) {
  return mapped(std::move(mesh), [&](const Point& p) {
    return Point{p[0] * scale + offset, p[1] * scale + offset, p[2] * scale + offset};
  });
}

TetMesh with_slivers(const TetMesh& mesh, double height) {
  TetMesh out;
  out.name = mesh.name;
  out.points = mesh.points;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    Point p{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] =
          (1 - height) / 3 *
              (corner(mesh, t, 0)[axis] + corner(mesh, t, 1)[axis] + corner(mesh, t, 2)[axis]) +
          height * corner(mesh, t, 3)[axis];
    const VertexId middle = id_of(out.points.size());
    out.points.push_back(p);
    for (std::size_t k = 0; k < 4; ++k) {
      Tet tet = mesh.tets[t];
      tet[k] = middle;
      out.tets.push_back(tet);
    }
  }
  return out;
}

TetMesh with_flat_side(int n) {
  TetMesh mesh = kuhn_mesh({n});
  std::map<Point, VertexId> id;
  for (std::size_t v = 0; v < mesh.n_points(); ++v) id[mesh.points[v]] = id_of(v);
  std::vector<Tet> flat;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto at = [&](int x, int y) {
        return id.at({static_cast<double>(x) / n, static_cast<double>(y) / n, 0});
      };
      flat.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  mesh.tets.insert(mesh.tets.begin(), flat.begin(), flat.end());
  return mesh;
}

Point turned(const Point& p) {
  return {0.36 * p[0] + 0.48 * p[1] + 0.8 * p[2], -0.8 * p[0] + 0.6 * p[1],
          -0.48 * p[0] - 0.64 * p[1] + 0.6 * p[2]};
}

TetMesh coarse_beside_fine() {
  TetMesh mesh = kuhn_mesh({2});
  const TetMesh fine = changed(kuhn_mesh({6}), 1, 0);
  const VertexId n = id_of(mesh.n_points());
  for (Point p : fine.points) {
    p[0] += 1;
    mesh.points.push_back(p);
  }
  for (Tet tet : fine.tets) {
    for (VertexId& v : tet) v += n;
    mesh.tets.push_back(tet);
  }
  return mesh;
}

std::vector<std::size_t> random_order(std::size_t n, std::uint64_t seed) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t k = n; k > 1; --k)
    std::swap(order[k - 1],
              order[static_cast<std::size_t>(chance(seed, k) * static_cast<double>(k))]);
  return order;
}

TetMesh permuted(const TetMesh& mesh, const std::vector<std::size_t>& order) {
  TetMesh out;
  out.name = mesh.name;
  std::vector<VertexId> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    out.points.push_back(mesh.points[order[k]]);
    place[order[k]] = id_of(k);
  }
  for (const std::size_t t : random_order(mesh.n_tets(), 5)) {
    Tet tet = mesh.tets[t];
    for (VertexId& v : tet) v = place[static_cast<std::size_t>(v)];
    out.tets.push_back(tet);
  }
  return out;
}

TetMesh exploded(const TetMesh& mesh) {
  TetMesh out;
  out.name = mesh.name;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    Tet tet{};
    for (std::size_t k = 0; k < 4; ++k) {
      tet[k] = id_of(out.points.size());
      out.points.push_back(corner(mesh, t, k));
    }
    out.tets.push_back(tet);
  }
  return out;
}

TetMesh cloud(std::vector<Point> points) {
  TetMesh out;
  out.name = "points";
  out.points = std::move(points);
  const std::size_t n = out.n_points();
  for (std::size_t first = 0; first < n; first += 4) {
    const std::size_t at = std::min(first, n - 4);
    out.tets.push_back({id_of(at), id_of(at + 1), id_of(at + 2), id_of(at + 3)});
  }
  return out;
}

std::vector<Point> on_faces_and_edges(const TetMesh& mesh, std::size_t n) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < n; ++i) {
    const auto t = static_cast<std::size_t>(chance(1, i) * static_cast<double>(mesh.n_tets()));
    const auto apart = static_cast<std::size_t>(chance(2, i) * 4);  // the corner not used
    std::array<double, 3> weights{1.0 / 3, 1.0 / 3, 1.0 / 3};
    if (i % 4 == 1) {
      const double a = chance(3, i), b = chance(4, i) * (1 - a);
      weights = {a, b, 1 - a - b};
    } else if (i % 4 == 2) {
      weights = {0.5, 0.5, 0};
    } else if (i % 4 == 3) {
      const double a = chance(3, i);
      weights = {a, 1 - a, 0};
    }
    Point p{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] += weights[k] * corner(mesh, t, (apart + 1 + k) % 4)[axis];
    points.push_back(p);
  }
  return points;
}

bool holds(const TetMesh& mesh, std::size_t tet, const Point& point, double least) {
  std::array<std::array<long double, 3>, 4> to{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      to[k][axis] = static_cast<long double>(corner(mesh, tet, k)[axis]) - point[axis];
  const auto volume = [&](std::size_t a, std::size_t b, std::size_t c) {
    return to[a][0] * (to[b][1] * to[c][2] - to[b][2] * to[c][1]) -
           to[a][1] * (to[b][0] * to[c][2] - to[b][2] * to[c][0]) +
           to[a][2] * (to[b][0] * to[c][1] - to[b][1] * to[c][0]);
  };
  const std::array<long double, 4> parts{volume(1, 2, 3), -volume(0, 2, 3), volume(0, 1, 3),
                                         -volume(0, 1, 2)};
  const long double whole = parts[0] + parts[1] + parts[2] + parts[3];
  if (whole == 0) return false;
  return std::ranges::all_of(parts, [&](long double part) { return part / whole >= least; });
}

}  // namespace m2m_transfer::stability
