// Chares that hold one part each of a mesh which the program cuts. MeshPiece is a Piece
// (coupling.hpp) that has the mesh, and create_pieces() gives each chare its part.
//
// Sample: tests/install/outside/coupling.cpp
//
//     struct Patch : tess::Chare<Patch>, MeshPiece<Patch> {
//       void loaded() {
//         for (const Point& p : mesh.points) field.push_back(exact(p, 0));
//       }
//       // …
//         ar(couplings, mesh, field);
//       }
//       std::vector<double> field;
//     };
//       // …
//       return create_pieces<Patch>(mesh, 4);
//       // …
//         co_await down.apply<&Patch::field, &Patch::field>();
//
// The ghosts of a piece are targets as well, so that what it takes it can also give. Each gets the
// value that the piece which owns the point gets. A target piece of a conservative coupling shows
// view_of(mesh) in a mesh_view() of its own, and takes values only for the points that it owns.
#pragma once

#include "m2m/couple/piece.hpp"
#include "m2m/mesh_parts.hpp"

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

namespace tess::m2m {

/// A second base class of a chare that holds a part of a mesh. The chare has a member function
/// `void loaded()`, which is called when the part is there.
template <class C>
class MeshPiece : public Piece<C> {
 public:
  MeshPart mesh;  ///< serialised by the chare if it migrates

  [[nodiscard]] MeshView mesh_view() const {
    MeshView view = view_of(mesh);
    view.n_owned = std::ssize(mesh.points);
    return view;
  }
  /// Takes its part, and calls the member function loaded() of the chare.
  void m2m_load(const MeshPart& part) {
    mesh = part;
    static_cast<C&>(*this).loaded();
  }

 protected:
  MeshPiece() = default;
};

/// An array of `n` chares of class C, a MeshPiece with a one-dimensional index. Each gets its part
/// of the mesh before the enclosing epoch ends, with so many layers of tetrahedra of other parts
/// around its own: source_halo_layers() and target_halo_layers() (transfer_kind.hpp) say how many a
/// kind needs. Throws as mesh_parts() does.
template <class C>
[[nodiscard]] ArrayProxy<C> create_pieces(const TetMesh& mesh, std::int32_t n,
                                          PartitionMethod method = PartitionMethod::curve,
                                          std::int32_t halo_layers = 0) {
  const std::vector<MeshPart> parts = mesh_parts(mesh, n, method, halo_layers);
  const ArrayProxy<C> array = create<C>(range(n));
  for (std::int32_t k = 0; k < n; ++k)
    array[{k}].template send<&MeshPiece<C>::m2m_load>(parts[static_cast<std::size_t>(k)]);
  return array;
}

}  // namespace tess::m2m
