#include "apps/surface_file/formats.hpp"
#include "runtime/base/open_file.hpp"
#include "runtime/core/error.hpp"

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

namespace apps {

tess::dn::Surface read_stl(const std::string& path) {
  (void)tess::detail::open_file(path, "an STL file");  // its errors are clearer
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);  // 0: nothing is merged, split or left out
  if (scene == nullptr)
    tess::fail(tess::ErrorCode::bad_file, path, ": is not an STL file, or is truncated (",
               importer.GetErrorString(), ")");
  tess::dn::Surface surface;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      surface.vertices.push_back({p.x, p.y, p.z});
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3)
        tess::fail(tess::ErrorCode::bad_file, path, ": facet ", surface.triangles.size(), " has ",
                   face.mNumIndices, " vertices instead of three");
      surface.triangles.push_back(
          {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    }
  }
  return surface;
}

}  // namespace apps
