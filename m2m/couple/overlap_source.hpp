// What a piece knows of a conservative coupling that it gives values to: the rows by which it
// computes the loads of target pieces.
#pragma once

#include "m2m/couple/overlap_messages.hpp"
#include "m2m/couple/rows_of_search.hpp"

#include <map>

namespace tess::m2m {

class OverlapSource {
 public:
  CouplingSetup setup;

  /// Forgets the last search, and returns the boxes of the cover.
  [[nodiscard]] std::vector<Aabb> start_search(const MeshView& mesh);
  [[nodiscard]] OverlapAnswer answer(const MeshView& mesh, const OverlapQuery& query);
  /// Ends the search with a piece: the rows that are not shared stay here.
  [[nodiscard]] PartialRows share(const MeshView& mesh, const SharedRows& shared);

  /// Calls send(target piece, loads) for every target piece that overlaps this one. `values`: a row
  /// per point, tetrahedron or corner, as the coupling's source_values say.
  template <class Send>
  void give(const MeshView& mesh, std::span<const double> values, detail::Taker take,
            const Send& send) {
    rows_of_search_.check(n_unknowns(mesh, setup.source_values));
    cover_ = {};
    const std::size_t n_components = components_of(mesh, values);
    const std::uint32_t round = rounds_[take->channel]++;
    for (const auto& [target, given] : given_)
      send(target, GivenValues{setup.id, {}, take, round, loads(given, values, n_components)});
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(setup, rows_of_search_, cover_, given_, rounds_);
  }

 private:
  struct Given {
    Rows<double> rows{};           // after the search: those that are not shared
    std::vector<VertexId> sent{};  // unknowns whose values are sent, too
    template <class Ar>
    void serialize(Ar& ar) {
      ar(rows, sent);
    }
  };
  [[nodiscard]] std::size_t components_of(const MeshView& mesh,
                                          std::span<const double> values) const;
  [[nodiscard]] std::vector<double> loads(const Given& given, std::span<const double> values,
                                          std::size_t n_components) const;

  RowsOfSearch rows_of_search_;
  Cover cover_;
  std::map<collide::OwnerId, Given> given_;  // per target piece
  std::map<std::uint64_t, std::uint32_t> rounds_;
};

}  // namespace tess::m2m
