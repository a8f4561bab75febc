// The search of a target piece of a transposed coupling. No geometry is looked at: the piece holds
// donors of the coupling forth, and learns for which points they are. So it has the weights of its
// vertices, of which those of ghosts go to the pieces that own these. In the end each vertex that
// the piece owns has a row, by ascending ids of the points.
#pragma once

#include "m2m/couple/search_step.hpp"
#include "m2m/mesh_view.hpp"

#include <map>
#include <vector>

namespace tess::m2m {

/// What a piece that gives forces sends before the first step. `found`: by the coupling forth.
/// `n_lost`: points that have no donor.
[[nodiscard]] Addressed<SearchAnswer> donated(CouplingId id, const MeshView& mesh,
                                              const TargetFound& found, collide::OwnerId me,
                                              std::uint64_t& n_lost);

class TransposedSearch {
 public:
  TransposedSearch() = default;
  /// `rows`: of the donors that this piece holds, per piece that they give values in the coupling
  /// forth, over the points of this one.
  explicit TransposedSearch(Addressed<Rows<double>> rows);

  /// The points that others may hold, and the ghosts that get weights; `me`: the piece.
  [[nodiscard]] std::vector<PointReport> point_reports(const MeshView& mesh,
                                                       collide::OwnerId me) const;
  /// SharedPoints and what is donated before the first step, weights of ghosts before the second.
  void add(SearchAnswer answer);
  /// Two steps. `found` is filled in by the second. Throws Error (bad_mesh) if two pieces give the
  /// force of one point.
  [[nodiscard]] SearchStep next(const CouplingSetup& setup, const MeshView& mesh,
                                TargetFound& found);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(rows_, points_, owners_, weights_, has_passed_);
  }

 private:
  struct GhostOwner {
    collide::OwnerId piece{};
    VertexId vertex = 0;  // there
  };
  /// The weights of ghosts, for the pieces that own them; keeps the others.
  [[nodiscard]] Addressed<SearchAnswer> pass_on(CouplingId id, const MeshView& mesh);
  void finish(const CouplingSetup& setup, const MeshView& mesh, TargetFound& found,
              SearchStep& step);

  std::map<collide::OwnerId, Rows<double>> rows_;
  std::map<collide::OwnerId, DonatedPoints> points_;  // per row of each
  std::map<VertexId, GhostOwner> owners_;             // of ghosts
  std::vector<TransposedWeight> weights_;             // of vertices of this piece
  bool has_passed_ = false;
};

}  // namespace tess::m2m
