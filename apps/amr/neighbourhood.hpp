// What a leaf knows of the leaves behind its faces, and the level that it chooses beside them: the
// rules by which the tree changes, without messages.
//
// For each face it knows whether the leaves behind it are coarser (-1), of its level (0) or finer
// (1). A leaf first chooses a level by its own cells. Then it hears of the choices of its
// neighbours: it raises its own until no neighbour is two above it, and it does not merge with
// siblings of which one does not merge. Choices only rise, so they end at the same levels in any
// order: the coarsest 2:1 balanced tree that is fine enough.
#pragma once

#include "apps/amr/block_index.hpp"
#include "apps/amr/problem.hpp"

#include <vector>

namespace amr {

using Sides = std::array<std::int8_t, n_faces>;

/// A leaf behind a face; `quadrant`: the quarter of its face that the other leaf touches.
struct Neighbour {
  BlockIndex index;
  std::int32_t quadrant = 0;
};

/// A neighbour's choice of level, as it is sent.
struct Choice {
  Face face = 0;  ///< of the receiver
  std::int32_t quadrant = 0;
  std::int32_t level = 0;
};

class Neighbourhood {
 public:
  Neighbourhood() = default;
  explicit Neighbourhood(BlockIndex own) : own_(own) {}

  [[nodiscard]] std::int32_t side(Face face) const {
    return sides_[static_cast<std::size_t>(face)];
  }
  void set_sides(const Sides& sides) { sides_ = sides; }
  /// Takes the outer faces of the child `octant`, which becomes a part of this leaf.
  void take_sides(std::int32_t octant, const Sides& sides);

  [[nodiscard]] std::vector<Neighbour> behind(Face face) const;

  [[nodiscard]] bool has_chosen() const { return has_chosen_; }
  /// The level after the change that is being planned.
  [[nodiscard]] std::int32_t choice() const { return choice_; }
  /// By the largest difference of two cells.
  void choose(double steepness, const Problem& problem);
  /// True if the choice rose.
  [[nodiscard]] bool hear(const Choice& of_neighbour);

  /// What will be behind the faces after the change: of this leaf, if it stays, otherwise of the
  /// parent or the child that has its part `octant`. Faces within the parent or this leaf are 0.
  [[nodiscard]] Sides next_sides() const;
  [[nodiscard]] Sides next_sides(std::int32_t octant) const;
  /// The leaf stays, with these sides.
  void stay() {
    sides_ = next_sides();
    has_chosen_ = false;
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(own_, sides_, has_chosen_, choice_, choices_);
  }

 private:
  [[nodiscard]] bool is_sibling(Face face) const {
    return own_.level() > 0 && !is_outer(own_.octant(), face);
  }
  /// The chosen level behind a quarter of a face, relative to this one's.
  [[nodiscard]] std::int8_t relation(Face face, std::int32_t quadrant) const;

  BlockIndex own_;
  Sides sides_{};
  bool has_chosen_ = false;
  std::int32_t choice_ = 0;
  std::array<std::array<std::int32_t, n_quadrants>, n_faces> choices_{};  // of neighbours
};

}  // namespace amr
