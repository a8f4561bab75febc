// The target points that lie farthest from the source, of those that are not in it: where a
// coupling deserves a look.
#pragma once

#include "m2m/mesh.hpp"
#include "m2m/status.hpp"
#include "runtime/core/algorithm.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tess::m2m {

struct WorstPlace {
  GlobalId point = -1;  ///< in the target mesh
  Point at{};
  double distance = 0;  ///< if snapped: from its tetrahedron; if outside: from the nearest vertex
  Status status = Status::outside;
  friend bool operator==(const WorstPlace&, const WorstPlace&) = default;
};

/// Holds at most n_most places, the farthest first, of equal ones the lowest point first. So a list
/// joined from parts does not depend on the parts.
class WorstPlaces {
 public:
  static constexpr std::size_t n_most = 5;

  void add(const WorstPlace& place) {
    const auto before = [](const WorstPlace& a, const WorstPlace& b) {
      return a.distance > b.distance || (a.distance == b.distance && a.point < b.point);
    };
    if (list_.size() == n_most && !before(place, list_.back())) return;
    list_.insert(std::upper_bound(list_.begin(), list_.end(), place, before), place);
    if (list_.size() > n_most) list_.pop_back();
  }
  WorstPlaces& operator+=(const WorstPlaces& other) {
    for (const WorstPlace& place : other.list_) add(place);
    return *this;
  }
  [[nodiscard]] std::span<const WorstPlace> list() const { return list_; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(list_);
  }

 private:
  std::vector<WorstPlace> list_;
};

}  // namespace tess::m2m
