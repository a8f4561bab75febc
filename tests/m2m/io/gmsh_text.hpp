// Writes meshes in the format of gmsh, for tests of readers.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <type_traits>

namespace tess::test {

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/// The mesh in the format that gmsh writes. Node tags differ by `gap`.
inline std::string as_gmsh(const m2m::TetMesh& mesh, bool legacy, bool binary, std::uint64_t gap) {
  std::string out =
      std::string("$MeshFormat\n") + (legacy ? "2.2 " : "4.1 ") + (binary ? "1 8\n" : "0 8\n");
  if (binary) put(out, 1);
  if (binary) out += "\n";
  out += "$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"box\"\n$EndPhysicalNames\n$Nodes\n";
  const auto number = [&](auto value, const char* end = " ") {
    if (binary) return put(out, value);
    if constexpr (std::is_floating_point_v<decltype(value)>) {
      std::array<char, 40> text;
      std::snprintf(text.data(), text.size(), "%.17g", value);
      out += text.data();
    } else {
      out += std::to_string(value);
    }
    out += end;
  };
  const auto n = mesh.n_points();
  const auto tag = [&](m2m::VertexId v) { return static_cast<std::uint64_t>(v) * gap + 3; };
  const auto point = [&](const m2m::Point& p) {
    number(p[0]);
    number(p[1]);
    number(p[2], "\n");
  };
  if (legacy) {
    out += std::to_string(n) + "\n";
    for (std::size_t v = 0; v < n; ++v) {
      number(static_cast<int>(tag(static_cast<m2m::VertexId>(v))));
      point(mesh.points[v]);
    }
  } else {
    for (const std::uint64_t x :
         {std::uint64_t{1}, n, std::uint64_t{3}, tag(static_cast<m2m::VertexId>(n))})
      number(x);
    number(3);
    number(1);
    number(0);
    number(std::uint64_t{n}, "\n");
    for (std::size_t v = 0; v < n; ++v) number(tag(static_cast<m2m::VertexId>(v)), "\n");
    for (const m2m::Point& p : mesh.points) point(p);
  }
  out += "\n$EndNodes\n$Elements\n";
  const auto m = mesh.n_tets();
  if (legacy) {
    out += std::to_string(m + 1) + "\n";
    if (binary) {
      for (const int x : {15, 1, 2}) put(out, x);
      for (const int x : {1, 1, 1, static_cast<int>(tag(0))}) put(out, x);
      for (const int x : {4, static_cast<int>(m), 2}) put(out, x);
    } else {
      out += "1 15 2 1 1 " + std::to_string(tag(0)) + "\n";
    }
    for (std::size_t t = 0; t < m; ++t) {
      number(static_cast<int>(t + 2));
      if (!binary) number(4);
      if (!binary) number(2);
      number(1);
      number(1);
      for (const m2m::VertexId v : mesh.tets[t]) number(static_cast<int>(tag(v)));
    }
  } else {
    for (const std::uint64_t x : {std::uint64_t{2}, m + 1, std::uint64_t{1}, m + 1}) number(x);
    for (const int x : {0, 1, 15}) number(x);
    for (const std::uint64_t x : {std::uint64_t{1}, std::uint64_t{1}, tag(0)}) number(x);
    for (const int x : {3, 1, 4}) number(x);
    number(std::uint64_t{m}, "\n");
    for (std::size_t t = 0; t < m; ++t) {
      number(std::uint64_t{t + 2});
      for (const m2m::VertexId v : mesh.tets[t]) number(tag(v));
    }
  }
  return out + "\n$EndElements\n";
}

}  // namespace tess::test
