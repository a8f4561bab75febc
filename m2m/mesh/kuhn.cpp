#include "m2m/kuhn.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <array>
#include <fmt/core.h>

namespace tess::m2m {
namespace {

constexpr std::int32_t largest_n = 700;  // 6 n³ fits in 31 bits
constexpr double largest_jitter = 0.2;   // keeps every tetrahedron positive

/// A hash of a vertex and an axis as a number in [-1, 1).
double noise(std::uint64_t vertex, std::uint64_t axis) {
  return 2 * unit(mix((vertex * 3 + axis + 1) * 0x9e3779b97f4a7c15U)) - 1;
}

/// The six paths from corner 0 to corner 7 of a cube (bits zyx). The middle corners of odd
/// permutations are swapped, so that all orientations are positive.
constexpr int corners_of_tets[6][4] = {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7},
                                       {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}};

}  // namespace

KuhnBox parse_kuhn(std::string_view name) {
  const auto refuse = [&] {
    fail(ErrorCode::bad_argument, "'", name,
         "': expected kuhn:N or kuhn:N@JITTER with N from 1 to ", largest_n,
         " and JITTER from 0 to ", largest_jitter);
  };
  if (!name.starts_with("kuhn:")) refuse();
  const std::string_view size = name.substr(5);
  const std::size_t at = std::min(size.find('@'), size.size());
  const auto n = parse_number<decltype(KuhnBox::n)>(size.substr(0, at));
  const auto jitter = at == size.size() ? 0.0 : parse_number<double>(size.substr(at + 1));
  if (!n || *n < 1 || *n > largest_n || !jitter || !(*jitter >= 0 && *jitter <= largest_jitter))
    refuse();
  return {*n, *jitter};
}

GlobalId n_points(KuhnBox box) {
  const GlobalId row = box.n + 1;
  return row * row * row;
}
GlobalId n_tets(KuhnBox box) {
  const GlobalId n = box.n;
  return 6 * n * n * n;
}

void kuhn_points(KuhnBox box, GlobalId first, std::span<Point> points) {
  const GlobalId row = box.n + 1;
  std::array<GlobalId, 3> at{first % row, first / row % row, first / row / row};
  for (Point& p : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool inner = at[axis] > 0 && at[axis] < box.n && box.jitter > 0;
      const double shift =
          inner ? box.jitter * noise(static_cast<std::uint64_t>(first), axis) : 0.0;
      p[axis] = (static_cast<double>(at[axis]) + shift) / box.n;
    }
    ++first;
    for (std::size_t axis = 0; ++at[axis] == row && axis < 2; ++axis) at[axis] = 0;
  }
}

void kuhn_tets(KuhnBox box, GlobalId first, std::span<Tet> tets) {
  const VertexId row = box.n + 1;
  const VertexId plane = row * row;
  const VertexId corner[8] = {0, 1, row, row + 1, plane, plane + 1, plane + row, plane + row + 1};
  GlobalId cube = first / 6;
  auto c = static_cast<std::size_t>(first % 6);
  for (std::size_t t = 0; t < tets.size(); ++cube, c = 0) {
    const auto i = static_cast<VertexId>(cube % box.n);
    const auto j = static_cast<VertexId>(cube / box.n % box.n);
    const auto k = static_cast<VertexId>(cube / box.n / box.n);
    const VertexId origin = i + j * row + k * plane;
    for (; c < 6 && t < tets.size(); ++c, ++t)
      for (std::size_t v = 0; v < 4; ++v) tets[t][v] = origin + corner[corners_of_tets[c][v]];
  }
}

TetMesh kuhn_mesh(KuhnBox box) {
  if (box.n < 1 || box.n > largest_n || !(box.jitter >= 0 && box.jitter <= largest_jitter)) {
    fail(ErrorCode::bad_argument, "kuhn box of n = ", box.n, " and jitter ", box.jitter,
         "; choose n from 1 to ", largest_n, " and jitter from 0 to ", largest_jitter);
  }
  TetMesh mesh;
  mesh.name =
      box.jitter > 0 ? fmt::format("kuhn:{}@{}", box.n, box.jitter) : fmt::format("kuhn:{}", box.n);
  mesh.points.resize(static_cast<std::size_t>(n_points(box)));
  mesh.tets.resize(static_cast<std::size_t>(n_tets(box)));
  kuhn_points(box, 0, mesh.points);
  kuhn_tets(box, 0, mesh.tets);
  return mesh;
}

}  // namespace tess::m2m
