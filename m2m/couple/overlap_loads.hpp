// Where the loads of a target piece's places come from. A row that only one source piece has stays
// there, and its load is sent. The parts of a row that several source pieces have come here: they
// are added, and the row is applied here, to values that these pieces send. Both compute a load
// from the same weights in the same order of ids.
#pragma once

#include "m2m/couple/overlap_messages.hpp"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tess::m2m {

class OverlapLoads {
 public:
  /// The places for which a source piece has a row, in its order.
  void add_source(collide::OwnerId piece, std::vector<std::uint32_t> places);
  /// After all of these: per source piece and row, 1 if others have a part of the row, too.
  [[nodiscard]] Addressed<std::vector<std::uint8_t>> shared();
  void add(PartialRows partial) { partial_.push_back(std::move(partial)); }
  /// After all of these.
  void join();

  [[nodiscard]] std::size_t n_sources() const { return sources_.size(); }

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
    ar(sources_, partial_, n_values_, shared_places_, shared_rows_);
  }

 private:
  struct Source {
    std::vector<std::uint32_t> places{};  // whose loads it sends, in its order
    std::vector<std::uint32_t> shared{};  // of which it has a part, in its order
    std::uint32_t first_value = 0;        // of its unknowns, among those of all sources
    std::uint32_t n_values = 0;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(places, shared, first_value, n_values);
    }
  };

  std::map<collide::OwnerId, Source> sources_;
  std::vector<PartialRows> partial_;          // until join()
  std::uint32_t n_values_ = 0;                // of all sources
  std::vector<std::uint32_t> shared_places_;  // whose loads are computed here
  Rows<double> shared_rows_;                  // for each; columns: values of all sources
};

}  // namespace tess::m2m
