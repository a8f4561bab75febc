#include "m2m/io/field_reader.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::m2m {
namespace {

[[noreturn]] void other_mesh(const TetMesh& mesh, const std::string& path) {
  fail(ErrorCode::bad_mesh, path, ": its fields do not fit the mesh ", mesh.name,
       "; read the mesh from the same file");
}

}  // namespace

std::vector<double> values_of_tets(const TetMesh& mesh, std::vector<double> values,
                                   std::size_t n_components, const std::string& path) {
  if (mesh.element_of_tet.empty()) {
    if (values.size() != mesh.n_tets() * n_components) other_mesh(mesh, path);
    return values;
  }
  std::vector<double> out(mesh.n_tets() * n_components);
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    const auto element = static_cast<std::size_t>(mesh.element_of_tet[t]);
    if (element >= values.size() / n_components) other_mesh(mesh, path);
    std::copy_n(values.data() + element * n_components, n_components,
                out.data() + t * n_components);
  }
  return out;
}

std::string clean_name(std::string_view name) {
  std::string clean(name);
  std::replace_if(
      clean.begin(), clean.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  return clean;
}

void check_n_points(const TetMesh& mesh, std::int64_t n_vertices, const std::string& path) {
  if (static_cast<std::int64_t>(mesh.n_points()) != n_vertices) other_mesh(mesh, path);
}

}  // namespace tess::m2m
