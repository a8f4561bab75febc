// Says which source pieces give values to the places of a target piece. A source piece gives values
// to some places. If the kind is conservative these are loads, and a row that only one source piece
// has stays there. The parts of a row that several source pieces have come here: they are added, and
// the row is applied here, to values that these pieces send. Both compute a load from the same
// weights in the same order of ids. Other couplings may apply all of their rows here.
#pragma once

#include "m2m/couple/messages.hpp"

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace tess::m2m {

/// A weight of a row that is applied here, to the value of a point of a source piece.
struct PlaceWeight {
  std::uint32_t place = 0;
  VertexId vertex = 0;  ///< in the source piece
  collide::OwnerId source{};
  double weight = 0;
};

class GivenPlaces {
 public:
  /// The places that a source piece gives values or has rows for, in its order.
  void add_source(collide::OwnerId piece, std::vector<std::uint32_t> places);
  /// After all of these, for rows: which ones each source piece keeps, as positions among its own.
  [[nodiscard]] Addressed<std::vector<std::uint32_t>> keep_rows();
  /// After all of these: the other rows of the source pieces.
  void join(std::vector<std::pair<collide::OwnerId, PartialRows>> partial);

  /// In place of all these: rows that are applied here, by place; the weights of a row are added
  /// in their order. Returns the points whose values each source piece has to send.
  [[nodiscard]] Addressed<std::vector<VertexId>> keep_weights(std::span<const PlaceWeight> weights);

  [[nodiscard]] std::size_t n_sources() const { return sources_.size(); }
  /// Calls visit(source piece, the places that it gives values, in its order).
  template <class Visit>
  void for_sources(const Visit& visit) const {
    for (const auto& [piece, source] : sources_) visit(piece, std::span(source.places));
  }
  /// What keep_weights() got, in the same order.
  [[nodiscard]] std::vector<PlaceWeight> weights() const;
  /// The places that a source piece gives values, in its order.
  [[nodiscard]] std::span<const std::uint32_t> places_of(collide::OwnerId source) const {
    return sources_.at(source).places;
  }

  struct Sums {
    std::size_t n_components = 0;
    std::vector<double> values;      ///< per place × component
    std::vector<ValueRange> ranges;  ///< the same, if they are sent
  };
  /// The loads of a round: a message of each source piece.
  [[nodiscard]] Sums add_up(const std::vector<GivenValues>& messages, std::size_t n_places,
                            bool with_ranges) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(sources_, n_values_, shared_places_, shared_rows_);
  }

 private:
  struct Source {
    std::vector<std::uint32_t> places{};  // whose values or loads it sends, in its order
    std::vector<std::uint32_t> shared{};  // of which it has a part, in its order
    std::uint32_t first_value = 0;        // of its unknowns, among those of all sources
    std::uint32_t n_values = 0;
    std::vector<VertexId> sent{};  // these unknowns, if keep_weights() chose them
    template <class Ar>
    void serialize(Ar& ar) {
      ar(places, shared, first_value, n_values, sent);
    }
  };

  std::map<collide::OwnerId, Source> sources_;
  std::uint32_t n_values_ = 0;                // of all sources
  std::vector<std::uint32_t> shared_places_;  // whose loads are computed here
  Rows<double> shared_rows_;                  // for each; columns: values of all sources
};

}  // namespace tess::m2m
