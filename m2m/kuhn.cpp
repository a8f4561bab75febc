#include "m2m/kuhn.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"

#include <charconv>
#include <cstdlib>
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
  KuhnBox box;
  if (!name.starts_with("kuhn:")) refuse();
  const char* const end = name.data() + name.size();
  auto [next, error] = std::from_chars(name.data() + 5, end, box.n);
  if (error != std::errc() || box.n < 1 || box.n > largest_n) refuse();
  if (next != end) {
    if (*next != '@') refuse();
    const auto [last, bad] = std::from_chars(next + 1, end, box.jitter);
    if (bad != std::errc() || last != end || !(box.jitter >= 0 && box.jitter <= largest_jitter))
      refuse();
  }
  return box;
}

TetMesh kuhn_mesh(KuhnBox box) {
  if (box.n < 1 || box.n > largest_n || !(box.jitter >= 0 && box.jitter <= largest_jitter)) {
    fail(ErrorCode::bad_argument, "kuhn box of n = ", box.n, " and jitter ", box.jitter,
         "; choose n from 1 to ", largest_n, " and jitter from 0 to ", largest_jitter);
  }
  TetMesh mesh;
  mesh.name =
      box.jitter > 0 ? fmt::format("kuhn:{}@{}", box.n, box.jitter) : fmt::format("kuhn:{}", box.n);
  const std::int32_t n = box.n;
  const std::int32_t row = n + 1;
  const std::int32_t plane = row * row;
  mesh.points.reserve(static_cast<std::size_t>(plane) * static_cast<std::size_t>(row));
  const auto coordinate = [&](std::int32_t i, std::uint64_t axis) {
    const bool inner = i > 0 && i < n && box.jitter > 0;
    const double shift = inner ? box.jitter * noise(mesh.points.size(), axis) : 0.0;
    return (i + shift) / n;
  };
  for (std::int32_t k = 0; k <= n; ++k) {
    for (std::int32_t j = 0; j <= n; ++j) {
      for (std::int32_t i = 0; i <= n; ++i) {
        mesh.points.push_back({coordinate(i, 0), coordinate(j, 1), coordinate(k, 2)});
      }
    }
  }
  const std::int32_t corner[8] = {0,     1,         row,         row + 1,
                                  plane, plane + 1, plane + row, plane + row + 1};
  const auto side = static_cast<std::size_t>(n);
  mesh.tets.reserve(6 * side * side * side);
  for (std::int32_t k = 0; k < n; ++k) {
    for (std::int32_t j = 0; j < n; ++j) {
      for (std::int32_t i = 0; i < n; ++i) {
        const VertexId first = i + j * row + k * plane;
        for (const auto& c : corners_of_tets) {
          mesh.tets.push_back({first + corner[c[0]], first + corner[c[1]], first + corner[c[2]],
                               first + corner[c[3]]});
        }
      }
    }
  }
  return mesh;
}

}  // namespace tess::m2m
