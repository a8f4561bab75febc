// The search of a target piece for what overlaps its tetrahedra: of the rows of loads that source
// pieces have, which ones stay there.
#pragma once

#include "m2m/couple/point_directory.hpp"
#include "m2m/couple/search_step.hpp"
#include "m2m/mesh_view.hpp"
#include "m2m/rows/search/cover.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tess::m2m {

class OverlapSearch {
 public:
  OverlapSearch() = default;
  explicit OverlapSearch(Centring values) : to_cells_(values == Centring::cells) {}

  /// Starts, and returns boxes around the tetrahedra that get loads.
  [[nodiscard]] std::vector<Aabb> start(const MeshView& mesh);
  /// What the piece reports of its points if these get values; `me`: the piece.
  [[nodiscard]] std::vector<PointReport> point_reports(const MeshView& mesh,
                                                       collide::OwnerId me) const;
  void add(const collide::Hits& hits);
  /// Before the first step: the volume around a point that another piece owns.
  void set_volume(std::int32_t point, double volume) {
    volumes_[static_cast<std::size_t>(point)] = volume;
  }
  /// When all answers to the last step are here. `found` is filled in at the end.
  [[nodiscard]] SearchStep next(const CouplingSetup& setup, const MeshView& mesh,
                                TargetFound& found);
  void add(collide::OwnerId from, const OverlapAnswer& answer, TargetFound& found);
  void add(collide::OwnerId from, PartialRows rows) {
    partial_.emplace_back(from, std::move(rows));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(to_cells_, stage_, numbers_, volumes_, cover_, asked_, covered_, partial_);
  }

 private:
  enum class Stage : std::uint8_t { ask, choose, finish };
  /// The tetrahedra and places that were sent to a source piece.
  struct Asked {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> boxes{};  // (mine, theirs), from the hits
    std::vector<std::uint32_t> tets{};                             // as positions in numbers_
    std::vector<std::uint32_t> places{};                           // that may get a row
    template <class Ar>
    void serialize(Ar& ar) {
      ar(boxes, tets, places);
    }
  };

  [[nodiscard]] std::array<std::uint32_t, 4> places_of(const MeshView& mesh,
                                                       std::uint32_t tet) const;
  [[nodiscard]] Addressed<SearchQuery> queries(const CouplingSetup& setup, const MeshView& mesh);
  /// Masses and statuses.
  void finish(const MeshView& mesh, TargetFound& found);
  [[nodiscard]] std::vector<double> covered_fractions(const MeshView& mesh,
                                                      TargetFound& found) const;

  bool to_cells_ = false;
  Stage stage_ = Stage::ask;
  std::vector<std::int32_t> numbers_;  // of the tetrahedra that give a place loads, by id
  std::vector<double> volumes_;        // around each point, ghosts included; or of each cell
  Cover cover_;
  std::map<collide::OwnerId, Asked> asked_;
  std::vector<std::array<double, 4>> covered_;  // per number: loads of the constant 1
  std::vector<std::pair<collide::OwnerId, PartialRows>> partial_;
};

}  // namespace tess::m2m
