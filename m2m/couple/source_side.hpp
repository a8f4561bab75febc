// What a piece knows of a coupling that it gives values to. During a search: the cover of its
// tetrahedra, and what it found for each target piece that asked. After it: what was chosen of
// that, donors (source_donors.cpp) or rows of loads (source_overlaps.cpp).
#pragma once

#include "m2m/couple/messages.hpp"
#include "m2m/mesh_view.hpp"
#include "m2m/rows/search/best_donors.hpp"
#include "m2m/rows/search/cover.hpp"
#include "m2m/rows/search/nearest_cells.hpp"
#include "m2m/rows/search/nearest_vertex.hpp"
#include "m2m/rows/search/same_mesh.hpp"
#include "m2m/rows/weights/native_rows.hpp"
#include "m2m/rows/weights/rows.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tess::m2m {

/// The box around the points of a piece that can be the nearest of others: the corners of cells
/// that it owns, or without cells all its points. If cells are sought, that of its own cells.
[[nodiscard]] Aabb box_of_nearest(const MeshView& mesh, const CouplingSetup& setup);

class SourceSide {
 public:
  CouplingSetup setup;

  /// Forgets the last search, and returns the boxes of the cover. Where the mesh has stayed as it
  /// was, the cover and what finds nearest vertices are kept.
  [[nodiscard]] std::vector<Aabb> start_search(const MeshView& mesh);
  [[nodiscard]] bool has_kept_cover() const { return stays_ == SameMesh::Answer::same; }
  /// Keeps a query. Returns true if no other waits for answers().
  [[nodiscard]] bool add(SearchQuery query);
  /// The answers to all queries that wait: points are located in one pass over the tetrahedra near
  /// to them. Adds to `n_tested` how many pairs of a tetrahedron and a point in its box, or of
  /// tetrahedra that no face clearly separates, were looked at.
  [[nodiscard]] Addressed<SearchAnswer> answers(const MeshView& mesh, std::uint64_t& n_tested);
  /// Ends the search with a target piece. Returns the answer that it waits for, if it does. Adds to
  /// `n_linear` as Tally::n_linear counts.
  [[nodiscard]] Addressed<SearchAnswer> choose(const MeshView& mesh, Choice choice,
                                               std::uint64_t& n_linear);

  /// Calls send(target piece, values) for every target piece that gets values from this one.
  /// `values`: of all points of the piece, n_points × n_components, row-major; or a row per
  /// tetrahedron or corner, as the coupling's source_values say.
  void give(const MeshView& mesh, std::span<const double> values, detail::Taker take,
            const std::function<void(collide::OwnerId, GivenValues)>& send);
  /// Target pieces that no source piece gives values: they hear of each round from this one.
  [[nodiscard]] std::span<const collide::OwnerId> attached() const { return attached_; }
  /// The weights of the donors of each target piece, over the points of the piece, in the order of
  /// the values of give().
  [[nodiscard]] Addressed<Rows<double>> donor_rows(const MeshView& mesh);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(setup, same_, stays_, n_rows_, cover_, queries_, given_, attached_, rounds_,
       gradient_vertices_, gradient_rows_, has_fits_);
  }

 private:
  /// What a target piece gets: donors, or with conservative kinds rows. With kind native the rows
  /// that are not empty stand for their donors. Until the choice: what the answer has.
  struct Given {
    std::vector<Donor> donors{};
    Rows<double> rows{};
    std::vector<VertexId> sent{};       // unknowns whose raw values are sent, too
    std::vector<NativePoint> points{};  // of the donors, until the choice
    template <class Ar>
    void serialize(Ar& ar) {
      ar(donors, rows, sent, points);
    }
  };

  /// What the queries for donors find, in their order.
  [[nodiscard]] std::vector<BestDonors> locate(const MeshView& mesh,
                                               std::span<const SearchQuery> queries,
                                               std::uint64_t& n_tested);
  [[nodiscard]] DonorAnswer answer_points(const SearchQuery& query, BestDonors found);
  [[nodiscard]] NearestAnswer answer_nearest(const MeshView& mesh, const NearestQuery& query);
  [[nodiscard]] OverlapAnswer answer_overlaps(const MeshView& mesh, collide::OwnerId target,
                                              const TargetTets& tets, std::uint64_t& n_tested);
  void choose_donors(const MeshView& mesh, const Choice& choice, std::uint64_t& n_linear);
  [[nodiscard]] PartialRows choose_rows(const MeshView& mesh, const Choice& choice);

  /// Ends the job if the piece's mesh has changed since the search: donors are positions in it.
  void check_rows(const MeshView& mesh) const;
  /// Frees what only the search needs, and makes what only an application needs.
  void prepare(const MeshView& mesh);
  /// n_points × n_components where a donor needs them; empty if the kind needs none.
  [[nodiscard]] std::vector<Point> gradients(std::span<const double> values,
                                             std::size_t n_components) const;
  [[nodiscard]] std::vector<double> interpolate(const MeshView& mesh, const Given& given,
                                                std::span<const double> values,
                                                std::span<const Point> gradients,
                                                std::size_t n_components) const;
  [[nodiscard]] std::vector<double> loads(const Given& given, std::span<const double> values,
                                          std::size_t n_components) const;
  [[nodiscard]] Rows<double> weights_of(const MeshView& mesh, const Given& given) const;

  SameMesh same_;
  SameMesh::Answer stays_ = SameMesh::Answer::moved;  // in the last search
  std::uint64_t n_rows_ = 0;                          // of values, in the last search
  Cover cover_;
  std::vector<SearchQuery> queries_;         // not answered yet
  std::map<collide::OwnerId, Given> given_;  // per target piece
  std::vector<collide::OwnerId> attached_;
  std::map<std::uint64_t, std::uint32_t> rounds_;  // per channel
  // The vertices of all donors, and a row for each, about 0.6 KB. A search keeps them where the mesh
  // stays as it was; the first application after it fits those that are missing.
  std::vector<VertexId> gradient_vertices_;
  Rows<Point> gradient_rows_;
  bool has_fits_ = false;  // for the last search
  // Of the points owned; built when it is asked for, and again after a migration.
  std::optional<NearestVertex> nearest_;
  std::optional<NearestCells> nearest_cells_;  // likewise
};

}  // namespace tess::m2m
