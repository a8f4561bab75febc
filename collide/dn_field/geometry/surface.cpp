#include "collide/dn_field/surface.hpp"

#include "collide/dn_field/geometry/surface_edges.hpp"
#include "runtime/base/open_file.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <ranges>
#include <tuple>

namespace tess::dn {
namespace {

/// Reads "17", "17/3", "17//4" or "-1/…" and moves past it; negative counts from the last vertex.
std::uint32_t face_vertex(const char*& at, std::size_t n_vertices, const std::string& place) {
  char* end = nullptr;
  const long long written = std::strtoll(at, &end, 10);
  if (end == at)
    fail(ErrorCode::bad_file, place, ": expected a vertex number in a face, found '", at, "'");
  while (*end != '\0' && *end != ' ' && *end != '\t') ++end;
  at = end;
  const auto count = static_cast<long long>(n_vertices);
  const long long index = written < 0 ? count + written : written - 1;
  if (index < 0 || index >= count)
    fail(ErrorCode::bad_file, place, ": face names vertex ", written, ", but ", n_vertices,
         " stand before it");
  return static_cast<std::uint32_t>(index);
}

Vec3 vertex(const char* at, const std::string& place) {
  std::array<double, 3> value{};
  for (double& v : value) {
    char* end = nullptr;
    v = std::strtod(at, &end);
    if (end == at)
      fail(ErrorCode::bad_file, place, ": a vertex needs three numbers, found '", at, "'");
    at = end;
  }
  return {value[0], value[1], value[2]};
}

}  // namespace

Bounds bounds(const Surface& surface) {
  Bounds box;
  for (const auto& triangle : surface.triangles)
    for (const auto v : triangle) box.extend(surface.vertices[v]);
  return box;
}

std::uint64_t fingerprint(const Surface& surface) {
  const auto hash = [](const auto& values) {
    return tess::hash_bytes(values.data(), values.size() * sizeof(values[0]));
  };
  return tess::mix(hash(surface.vertices) ^ tess::mix(hash(surface.triangles))) | 1U;
}

void validate(const Surface& surface) {
  if (surface.triangles.empty())
    fail(ErrorCode::bad_mesh, "surface has no triangles; a field needs at least one");
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const auto v : surface.triangles[t]) {
      if (v >= surface.vertices.size())
        fail(ErrorCode::bad_mesh, "triangle ", t, " names vertex ", v, " of ",
             surface.vertices.size());
      const Vec3 p = surface.vertices[v];
      if (!is_finite(p))
        fail(ErrorCode::bad_mesh, "vertex ", v, " of triangle ", t, " is (", p.x, ", ", p.y, ", ",
             p.z, "); remove it or give it a finite position");
    }
  const Vec3 size = bounds(surface).size();
  if (!(norm(size) > 0) || !is_finite(size))
    fail(ErrorCode::bad_mesh, "surface has extent ", norm(size),
         "; it must be positive and finite");
  const auto has_area = [&](std::size_t t) {
    const auto [a, b, c] = surface.corners(t);
    return norm(cross(b - a, c - a)) > 0;
  };
  const auto numbers = std::views::iota(std::size_t{0}, surface.triangles.size());
  if (std::ranges::none_of(numbers, has_area))
    fail(ErrorCode::bad_mesh, "all ", surface.triangles.size(),
         " triangles are without area; a field needs a surface");
}

std::vector<RimEdge> rim(const Surface& surface) {
  std::vector<RimEdge> edges;
  each_edge(surface, [&](const EdgeUse& edge) {
    const int surplus = edge.up - edge.down;
    if (surplus > 0) edges.push_back({edge.low, edge.high, surplus});
    if (surplus < 0) edges.push_back({edge.high, edge.low, -surplus});
  });
  return edges;
}

double disagreeing_share(const Surface& surface) {
  double between_two = 0, disagreeing = 0;
  each_edge(surface, [&](const EdgeUse& edge) {
    if (edge.up + edge.down != 2) return;
    between_two += 1;
    if (edge.up != edge.down) disagreeing += 1;
  });
  return between_two > 0 ? disagreeing / between_two : 0;
}

Surface welded(const Surface& surface) {
  std::vector<std::uint32_t> order(surface.vertices.size()), merged(surface.vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t v) {
    const Vec3 p = surface.vertices[v];
    return std::tuple(p.x, p.y, p.z, v);
  };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
  Surface result;
  for (const std::uint32_t v : order) {
    const Vec3 p = surface.vertices[v];
    if (result.vertices.empty() || !(result.vertices.back() == p)) result.vertices.push_back(p);
    merged[v] = static_cast<std::uint32_t>(result.vertices.size() - 1);
  }
  result.triangles.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles)
    result.triangles.push_back({merged[t[0]], merged[t[1]], merged[t[2]]});
  return result;
}

Surface read_obj(const std::string& path) {
  std::ifstream file = tess::detail::open_file(path, "an OBJ file");
  Surface surface;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const auto place = [&] { return text(path, ":", number); };
    if (line.starts_with("v ")) {
      surface.vertices.push_back(vertex(line.c_str() + 2, place()));
    } else if (line.starts_with("f ")) {
      const char* at = line.c_str() + 2;
      std::vector<std::uint32_t> polygon;
      const auto skip = [&] {
        while (*at == ' ' || *at == '\t') ++at;
      };
      for (skip(); *at != '\0'; skip())
        polygon.push_back(face_vertex(at, surface.vertices.size(), place()));
      if (polygon.size() < 3) fail(ErrorCode::bad_file, place(), ": a face needs three vertices");
      for (std::size_t i = 2; i < polygon.size(); ++i)
        surface.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
    }
  }
  if (surface.triangles.empty()) fail(ErrorCode::bad_file, path, ": holds no faces");
  validate(surface);
  return surface;
}

std::vector<double> area_sums(const Surface& surface) {
  std::vector<double> sums;
  sums.reserve(surface.triangles.size());
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    sums.push_back(sum += 0.5 * norm(cross(b - a, c - a)));
  }
  return sums;
}

SurfacePoint point_on(const Surface& surface, const std::vector<double>& sums, double first,
                      double second, double third) {
  const auto found = std::upper_bound(sums.begin(), sums.end() - 1, first * sums.back());
  const auto triangle = static_cast<std::uint32_t>(found - sums.begin());
  const auto [a, b, c] = surface.corners(triangle);
  const double root = std::sqrt(second);
  return {(1 - root) * a + (root * (1 - third)) * b + (root * third) * c,
          direction(cross(b - a, c - a)), triangle};
}

}  // namespace tess::dn
