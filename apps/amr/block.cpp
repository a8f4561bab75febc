#include "apps/amr/block.hpp"

#include <algorithm>

namespace amr {

Census Join::operator()(const Census& a, const Census& b) const {
  const Norms &x = a.norms, &y = b.norms;
  Census all{{x.mass + y.mass, x.l1 + y.l1, x.l2 + y.l2, std::max(x.linf, y.linf),
              std::max(x.largest, y.largest), std::min(x.least, y.least), x.hash + y.hash},
             a.n_blocks + b.n_blocks,
             a.n_new + b.n_new,
             a.of_level};
  for (std::size_t i = 0; i < all.of_level.size(); ++i) all.of_level[i] += b.of_level[i];
  return all;
}

tess::PeId Block::place(const BlockIndex& index, std::int32_t n_pes) {
  const auto bits = 3U * static_cast<std::uint32_t>(index.level());
  const double along = static_cast<double>(index.path - (std::uint64_t{1} << bits)) /
                       static_cast<double>(std::uint64_t{1} << bits);
  return tess::PeId{static_cast<std::int32_t>(along * n_pes)};
}

void Block::begin(Birth birth) {
  if (problem_.n_steps == 0) {
    problem_ = birth.problem;
    patch_ = Patch(problem_, index());
  }
  if (birth.octant < 0) {
    sides_ = birth.sides;
    patch_.take(std::move(birth.masses));
    return;
  }
  // One of eight children that merge here: it knows its own outer faces.
  for (Face face = 0; face < n_faces; ++face)
    if (is_outer(birth.octant, face))
      sides_[static_cast<std::size_t>(face)] = birth.sides[static_cast<std::size_t>(face)];
  patch_.take(birth.octant, birth.masses);
}

template <class Visit>
void Block::for_neighbours(Face face, const Visit& visit) const {
  const BlockIndex beside = index().neighbour(face);
  if (side(face) == 0) {
    visit(beside, 0);
  } else if (side(face) < 0) {
    visit(beside.parent(), quadrant_of(index().octant(), face / 2));
  } else {
    for (std::int32_t quadrant = 0; quadrant < n_quadrants; ++quadrant)
      visit(beside.child(octant_at(face ^ 1, quadrant)), 0);
  }
}

void Block::send_halos(std::int32_t sweep, Face face) const {
  std::int32_t n = 0;
  for_neighbours(face, [&](BlockIndex to, std::int32_t quadrant) {
    array()[to].send<&Block::receive_halo>(Halo{sweep, face ^ 1, quadrant,
                                                side(face) < 0   ? patch_.coarse_layers(face)
                                                : side(face) > 0 ? patch_.fine_layers(face, n++)
                                                                 : patch_.layers(face)});
  });
}

tess::Task Block::advance(std::int32_t first, std::int32_t n) {
  for (std::int32_t sweep = 3 * first; sweep < 3 * (first + n); ++sweep) {
    const std::int32_t axis = sweep % 3;
    const std::array<Face, 2> faces{2 * axis, 2 * axis + 1};
    std::int32_t n_halos = 0, n_flows = 0;
    for (const Face face : faces) {
      send_halos(sweep, face);
      n_halos += side(face) > 0 ? n_quadrants : 1;
      n_flows += side(face) > 0 ? n_quadrants : 0;
    }
    for (; n_halos > 0; --n_halos) {
      const Halo halo = co_await halos_.take(sweep);
      if (side(halo.face) > 0)
        patch_.set_halo(halo.face, halo.quadrant, halo.values);
      else
        patch_.set_halo(halo.face, halo.values);
    }
    patch_.compute_flows(axis);
    for (const Face face : faces)
      if (side(face) < 0)
        for_neighbours(face, [&](BlockIndex to, std::int32_t quadrant) {
          array()[to].send<&Block::receive_flows>(
              Flows{sweep, face ^ 1, quadrant, patch_.coarse_flows(face)});
        });
    for (; n_flows > 0; --n_flows) {
      const Flows flows = co_await flows_.take(sweep);
      if (problem_.corrected) patch_.set_flows(flows.face, flows.quadrant, flows.values);
    }
    patch_.apply_flows(axis);
  }
}

void Block::choose() {
  if (has_chosen_) return;
  has_chosen_ = true;
  choices_ = {};
  const double steepness = patch_.steepness();
  choice_ = level();
  if (steepness > problem_.refine) ++choice_;
  if (steepness < problem_.refine / 4) --choice_;
  choice_ = std::clamp(choice_, problem_.least_level, problem_.most_level);
  for (Face face = 0; face < n_faces; ++face)  // a sibling that is no leaf does not merge
    if (side(face) > 0 && level() > 0 && !is_outer(index().octant(), face))
      choice_ = std::max(choice_, level());
  tell();
}

void Block::tell() const {
  for (Face face = 0; face < n_faces; ++face)
    for_neighbours(face, [&](BlockIndex to, std::int32_t quadrant) {
      array()[to].send<&Block::hear>(Choice{face ^ 1, quadrant, choice_});
    });
}

void Block::hear(Choice of_neighbour) {
  choose();
  const Face face = of_neighbour.face;
  std::int32_t& known =
      choices_[static_cast<std::size_t>(face)][static_cast<std::size_t>(of_neighbour.quadrant)];
  known = std::max(known, of_neighbour.level);
  const bool is_sibling = level() > 0 && side(face) == 0 && !is_outer(index().octant(), face);
  const std::int32_t least = is_sibling && of_neighbour.level >= level()
                                 ? std::max(level(), of_neighbour.level - 1)
                                 : of_neighbour.level - 1;
  if (least <= choice_) return;
  choice_ = least;
  tell();
}

std::int8_t Block::relation(Face face, std::int32_t quadrant, std::int32_t own) const {
  const std::int32_t known = choices_[static_cast<std::size_t>(face)]
                                     [static_cast<std::size_t>(side(face) > 0 ? quadrant : 0)];
  TESS_CHECK(std::abs(known - own) <= 1, "level ", own, " beside level ", known);
  return static_cast<std::int8_t>(known - own);
}

void Block::change() {
  if (!has_chosen_) return;  // created by this change
  has_chosen_ = false;
  if (choice_ == level()) {
    for (Face face = 0; face < n_faces; ++face)
      sides_[static_cast<std::size_t>(face)] = relation(face, 0, choice_);
    return;
  }
  for (std::int32_t octant = 0; octant < (choice_ > level() ? n_octants : 1); ++octant) {
    // The eighth of this block that becomes a child, or the eighth of the parent that this block is.
    const std::int32_t part = choice_ > level() ? octant : index().octant();
    Birth birth{.problem = problem_};
    for (Face face = 0; face < n_faces; ++face)
      if (is_outer(part, face))
        birth.sides[static_cast<std::size_t>(face)] =
            relation(face, choice_ > level() ? quadrant_of(part, face / 2) : 0, choice_);
    birth.octant = choice_ > level() ? -1 : part;
    birth.masses = choice_ > level() ? patch_.refined(part) : patch_.coarsened();
    const BlockIndex to = choice_ > level() ? index().child(part) : index().parent();
    array()[to].send_or_create_home<&Block::begin>(std::move(birth));
  }
  destroy();
}

void Block::count(double time, const tess::Callback<Census>& result) {
  Census mine{patch_.compare(time), 1, is_new_ ? 1 : 0, {}};
  mine.of_level.at(static_cast<std::size_t>(level())) = 1;
  is_new_ = false;
  contribute(Join(), mine, result);
}

}  // namespace amr
