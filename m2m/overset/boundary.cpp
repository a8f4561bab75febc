#include "m2m/overset/boundary.hpp"

#include "m2m/overset/rim.hpp"
#include "m2m/rows/interpolate/orientation.hpp"
#include "m2m/surface/sides.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace tess::m2m {
namespace {

struct Face {
  std::array<VertexId, 3> key{};  // sorted
  std::array<VertexId, 3> corners{};
};

Point at(const TetMesh& mesh, VertexId v) {
  return mesh.points[static_cast<std::size_t>(v)];
}

/// The normal points out of the tetrahedron.
Face face_of(const TetMesh& mesh, const Side& side) {
  const Tet corners = outward(mesh, side);
  const Tet key = key_of(corners, 2);
  return {{key[0], key[1], key[2]}, {corners[0], corners[1], corners[2]}};
}

std::vector<Face> boundary_faces(const TetMesh& mesh) {
  std::vector<Face> faces;
  const std::array all{std::pair<GlobalId, GlobalId>{0, static_cast<GlobalId>(mesh.n_tets())}};
  for (const Side& side : boundary_sides(mesh, all)) faces.push_back(face_of(mesh, side));
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.key < b.key; });
  return faces;
}

/// Vertices that are connected by faces have the same root.
class Connected {
 public:
  explicit Connected(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  [[nodiscard]] std::size_t root(VertexId vertex) {
    auto v = static_cast<std::size_t>(vertex);
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(VertexId a, VertexId b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

/// Per face: whether its connected part encloses a cavity, that is a negative volume. A part that is
/// open to planes of symmetry is closed beyond them.
std::vector<bool> are_inner(const TetMesh& mesh, const std::vector<Face>& faces,
                            std::span<const SymmetryPlane> symmetry) {
  Connected parts(mesh.points.size());
  for (const Face& face : faces) {
    parts.join(face.corners[0], face.corners[1]);
    parts.join(face.corners[0], face.corners[2]);
  }
  std::map<std::size_t, std::vector<std::array<VertexId, 3>>> surfaces;  // by root
  for (const Face& face : faces) surfaces[parts.root(face.corners[0])].push_back(face.corners);
  std::map<std::size_t, double> volume;
  std::vector<Point> points = mesh.points;
  for (auto& [root, surface] : surfaces) {
    if (!symmetry.empty()) close(points, surface, symmetry);
    for (const auto& [a, b, c] : surface)
      volume[root] +=
          orientation(points[root], points[static_cast<std::size_t>(a)],
                      points[static_cast<std::size_t>(b)], points[static_cast<std::size_t>(c)]);
  }
  std::vector<bool> inner;
  for (const Face& face : faces) inner.push_back(volume[parts.root(face.corners[0])] < 0);
  return inner;
}

/// What a side set is chosen by: its name, or its number if it has none.
std::string name_of(const SideSet& set) {
  return set.name.empty() ? std::to_string(set.id) : set.name;
}

/// The keys of the faces of a side set, sorted.
std::vector<std::array<VertexId, 3>> keys_of(const TetMesh& mesh, const std::string& name) {
  for (const SideSet& set : mesh.side_sets) {
    if (name_of(set) != name) continue;
    std::vector<std::array<VertexId, 3>> keys;
    for (const Side& side : set.entries) keys.push_back(face_of(mesh, side).key);
    std::sort(keys.begin(), keys.end());
    return keys;
  }
  std::string known;
  for (const SideSet& set : mesh.side_sets) known += (known.empty() ? "" : ", ") + name_of(set);
  fail(ErrorCode::bad_argument, mesh.name, " has no side set ", name, "; it has ",
       known.empty() ? "none (ExodusII and gmsh files can have them): leave the wall out to take "
                       "the cavities, or give the file of a surface"
                     : known);
}

}  // namespace

OversetBoundary overset_boundary(const TetMesh& mesh, const std::string& wall,
                                 std::span<const SymmetryPlane> symmetry) {
  std::vector<Face> faces = boundary_faces(mesh);
  OversetBoundary out;
  out.on_outer.assign(mesh.points.size(), 0);
  const auto sort_in = [&](const Face& face, bool is_wall) {
    if (is_wall) {
      out.wall.push_back(face.corners);
    } else {
      for (const VertexId v : face.corners) out.on_outer[static_cast<std::size_t>(v)] = 1;
    }
  };
  const auto is_in_plane = [&](const Face& face) {
    return std::any_of(symmetry.begin(), symmetry.end(), [&](const SymmetryPlane& plane) {
      return std::all_of(face.corners.begin(), face.corners.end(),
                         [&](VertexId v) { return plane.holds(at(mesh, v)); });
    });
  };
  if (wall.empty()) {
    std::erase_if(faces, is_in_plane);
    const std::vector<bool> inner = are_inner(mesh, faces, symmetry);
    for (std::size_t i = 0; i < faces.size(); ++i) sort_in(faces[i], inner[i]);
  } else {
    const auto keys = keys_of(mesh, wall);
    for (const Face& face : faces)
      if (const bool is_wall = std::binary_search(keys.begin(), keys.end(), face.key);
          is_wall || !is_in_plane(face))
        sort_in(face, is_wall);
  }
  return out;
}

}  // namespace tess::m2m
