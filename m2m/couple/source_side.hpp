// What a piece knows of a coupling that it gives values to. During a search: the cover of its
// tetrahedra, and the donors it found for each target piece that asked. After it: the donors that
// were chosen.
#pragma once

#include "m2m/couple/messages.hpp"
#include "m2m/couple/rows_of_search.hpp"
#include "m2m/mesh_view.hpp"
#include "m2m/rows/conservative/overlap_rows.hpp"
#include "m2m/rows/search/cover.hpp"
#include "m2m/rows/search/nearest_vertex.hpp"
#include "m2m/rows/search/same_mesh.hpp"
#include "m2m/rows/weights/rows.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tess::m2m {

/// The box around the points of a piece that can be the nearest of others: the corners of
/// tetrahedra that it owns, or without tetrahedra all its points.
[[nodiscard]] Aabb box_of_nearest(const MeshView& mesh);

class SourceSide {
 public:
  CouplingSetup setup;

  /// Forgets the last search, and returns the boxes of the cover. Where the mesh has stayed as it
  /// was, the cover and what finds nearest vertices are kept.
  [[nodiscard]] std::vector<Aabb> start_search(const MeshView& mesh);
  /// Keeps a query. Returns true if no other waits for answers().
  [[nodiscard]] bool add(DonorQuery query);
  /// The answers to all queries that wait: their points are located in one pass over the
  /// tetrahedra near to them. Returns in `n_tested` how many pairs of a tetrahedron and a point in
  /// its box were looked at.
  [[nodiscard]] Addressed<DonorAnswer> answers(const MeshView& mesh, std::uint64_t& n_tested);
  [[nodiscard]] NearestAnswer answer(const MeshView& mesh, NearestQuery query);
  void choose(Choice choice);
  [[nodiscard]] bool has_kept_cover() const { return stays_ == SameMesh::Answer::same; }
  /// Calls send(target piece, values) for every target piece that gets values from this one.
  /// `values`: of all points of the piece, n_points × n_components, row-major; or a row per
  /// tetrahedron or corner, as the coupling's source_values say.
  template <class Send>
  void give(const MeshView& mesh, std::span<const double> values, detail::Taker take,
            const Send& send) {
    const std::size_t n_rows = n_unknowns(mesh, setup.source_values);
    rows_of_search_.check(n_rows);
    if (n_rows == 0) return;
    prepare(mesh);
    const std::size_t n_components = values.size() / n_rows;
    const std::vector<Point> slopes = gradients(values, n_components);
    const std::uint32_t round = rounds_[take->channel]++;
    for (const auto& [target, donors] : donors_)
      send(target,
           GivenValues{
               setup.id, {}, take, round, interpolate(mesh, donors, values, slopes, n_components)});
  }

  /// Calls send(target piece, rows) for every target piece that gets values from this one. The rows
  /// are over the points of the piece, in the order of the values of give().
  template <class Send>
  void give_rows(const MeshView& mesh, const Send& send) {
    rows_of_search_.check(n_unknowns(mesh, setup.source_values));
    prepare(mesh);
    for (const auto& [target, donors] : donors_) send(target, rows_of(mesh, donors));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(setup, same_, stays_, rows_of_search_, cover_, queries_, drafts_, donors_, rounds_,
       gradient_vertices_, gradient_rows_);
  }

 private:
  /// Frees what only this search needs, and makes what only an application needs.
  void prepare(const MeshView& mesh);
  /// n_points × n_components where a donor needs them; empty if the kind needs none.
  [[nodiscard]] std::vector<Point> gradients(std::span<const double> values,
                                             std::size_t n_components) const;
  [[nodiscard]] std::vector<double> interpolate(const MeshView& mesh, std::span<const Donor> donors,
                                                std::span<const double> values,
                                                std::span<const Point> gradients,
                                                std::size_t n_components) const;

  [[nodiscard]] Rows<double> rows_of(const MeshView& mesh, std::span<const Donor> donors) const;

  SameMesh same_;
  SameMesh::Answer stays_ = SameMesh::Answer::moved;  // in the last search
  RowsOfSearch rows_of_search_;
  Cover cover_;
  std::vector<DonorQuery> queries_;                        // not answered yet
  std::map<collide::OwnerId, std::vector<Donor>> drafts_;  // per target piece, as answered
  std::map<collide::OwnerId, std::vector<Donor>> donors_;  // per target piece, as chosen
  std::map<std::uint64_t, std::uint32_t> rounds_;          // per channel
  std::vector<VertexId> gradient_vertices_;                // the vertices of all donors
  Rows<Point> gradient_rows_;                              // a row for each
  // Of the points owned; built when it is asked for, and again after a migration.
  std::optional<NearestVertex> nearest_;
};

}  // namespace tess::m2m
