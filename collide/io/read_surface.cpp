#include "collide/read_surface.hpp"

#include "collide/io/formats.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace tess::dn {
namespace {

/// The ending of the name in lower case, with its dot.
std::string ending_of(std::string_view path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

void check(const Surface& surface) {
  if (surface.triangles.empty())
    fail(ErrorCode::bad_mesh, "holds no triangles; give a mesh of at least one face");
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const std::uint32_t v : surface.triangles[t]) {
      if (v >= surface.vertices.size())
        fail(ErrorCode::bad_mesh, "triangle ", t, " has vertex ", v, ", but there are ",
             surface.vertices.size());
      const auto& p = surface.vertices[v];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        fail(ErrorCode::bad_mesh, "vertex ", v, " of triangle ", t, " is (", p.x, ", ", p.y, ", ",
             p.z, "), which is not finite; repair the file");
    }
}

}  // namespace

bool names_surface(std::string_view path) {
  const std::string ending = ending_of(path);
  return ending == ".obj" || ending == ".ply" || ending == ".stl";
}

Surface read_surface(const std::string& path) {
  if (!names_surface(path))
    fail(ErrorCode::bad_file, path, ": is no surface by its name; give a file .obj, .ply or .stl");
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown))
    fail(ErrorCode::bad_file, path, ": is a directory; give a file .obj, .ply or .stl");
  const std::string ending = ending_of(path);
  try {
    Surface surface = ending == ".obj"   ? read_obj(path)
                      : ending == ".ply" ? read_ply(path)
                                         : read_stl(path);
    check(surface);
    return surface;
  } catch (const tess::Error& error) {
    if (std::string_view(error.what()).starts_with(path)) throw;
    fail(error.code(), path, ": ", error.what());
  }
}

}  // namespace tess::dn
