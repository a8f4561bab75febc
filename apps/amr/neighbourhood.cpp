#include "apps/amr/neighbourhood.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <cstdlib>

namespace amr {

void Neighbourhood::take_sides(std::int32_t octant, const Sides& sides) {
  for (Face face = 0; face < n_faces; ++face)
    if (is_outer(octant, face))
      sides_[static_cast<std::size_t>(face)] = sides[static_cast<std::size_t>(face)];
}

std::vector<Neighbour> Neighbourhood::behind(Face face) const {
  const BlockIndex beside = own_.neighbour(face);
  if (side(face) == 0) return {{beside, 0}};
  if (side(face) < 0) return {{beside.parent(), quadrant_of(own_.octant(), face / 2)}};
  std::vector<Neighbour> finer;
  for (std::int32_t quadrant = 0; quadrant < n_quadrants; ++quadrant)
    finer.push_back({beside.child(octant_at(face ^ 1, quadrant)), 0});
  return finer;
}

void Neighbourhood::choose(double steepness, const Problem& problem) {
  has_chosen_ = true;
  choices_ = {};
  choice_ = own_.level();
  if (steepness > problem.refine) ++choice_;
  if (steepness < problem.refine / 4) --choice_;
  choice_ = std::clamp(choice_, problem.least_level, problem.most_level);
  for (Face face = 0; face < n_faces; ++face)  // a sibling that is no leaf does not merge
    if (side(face) > 0 && is_sibling(face)) choice_ = std::max(choice_, own_.level());
}

bool Neighbourhood::hear(const Choice& of_neighbour) {
  const auto face = static_cast<std::size_t>(of_neighbour.face);
  std::int32_t& known = choices_[face][static_cast<std::size_t>(of_neighbour.quadrant)];
  known = std::max(known, of_neighbour.level);
  std::int32_t least = of_neighbour.level - 1;
  if (sides_[face] == 0 && is_sibling(of_neighbour.face) && of_neighbour.level >= own_.level())
    least = std::max(least, own_.level());
  if (least <= choice_) return false;
  choice_ = least;
  return true;
}

std::int8_t Neighbourhood::relation(Face face, std::int32_t quadrant) const {
  const std::int32_t known = choices_[static_cast<std::size_t>(face)]
                                     [static_cast<std::size_t>(side(face) > 0 ? quadrant : 0)];
  TESS_CHECK(std::abs(known - choice_) <= 1, "level ", choice_, " beside level ", known);
  return static_cast<std::int8_t>(known - choice_);
}

Sides Neighbourhood::next_sides() const {
  Sides sides{};
  for (Face face = 0; face < n_faces; ++face)
    sides[static_cast<std::size_t>(face)] = relation(face, 0);
  return sides;
}

Sides Neighbourhood::next_sides(std::int32_t octant) const {
  Sides sides{};
  for (Face face = 0; face < n_faces; ++face)
    if (is_outer(octant, face))
      sides[static_cast<std::size_t>(face)] =
          relation(face, choice_ > own_.level() ? quadrant_of(octant, face / 2) : 0);
  return sides;
}

}  // namespace amr
