// A leaf of the oct-tree: a chare that exists while the field is as steep as its cells are fine.
//
// It knows for each face whether the leaves behind it are coarser (-1), of its level (0) or finer (1),
// and nothing else of the tree. Two entry methods, each in an epoch of its own, change the tree:
//
//     plan    every leaf chooses a level by its own cells, and tells its neighbours. A leaf that
//             hears of a level two above its own choice raises its choice by one, and tells its
//             neighbours again; so does one that wants to merge with its siblings but hears that one
//             of them does not. Choices only rise, so they end at the same levels in any order of
//             messages: the coarsest 2:1 balanced tree that is fine enough. The end is the epoch's.
//     change  a leaf that goes up sends an eighth of its cells to each of eight children, one that
//             goes down sends its cells to its parent; the first message creates them. Then it is
//             destroyed. All know the levels behind their faces from the messages of `plan`.
#pragma once

#include "apps/amr/patch.hpp"
#include "runtime/runtime.hpp"

namespace amr {

/// Layers of a neighbour. `quadrant`: of the receiver's face, where the sender is finer.
struct Halo {
  std::int32_t sweep = 0;  ///< three per step
  Face face = 0;           ///< of the receiver
  std::int32_t quadrant = 0;
  std::vector<double> values;
};
struct Flows {
  std::int32_t sweep = 0;
  Face face = 0;
  std::int32_t quadrant = 0;
  std::vector<Quanta> values;
};
/// A neighbour's choice of level.
struct Choice {
  Face face = 0;  ///< of the receiver
  std::int32_t quadrant = 0;
  std::int32_t level = 0;
};

using Sides = std::array<std::int8_t, n_faces>;
/// What a new leaf begins with; `octant`: the part of it, or -1 for all.
struct Birth {
  Problem problem;
  std::int32_t octant = -1;
  Sides sides{};
  std::vector<Quanta> masses{};
};

/// What is known of all leaves.
struct Census {
  Norms norms;
  std::int64_t n_blocks = 0;
  std::int64_t n_new = 0;  ///< since the last census
  std::array<std::int64_t, 12> of_level{};
};
struct Join {
  Census operator()(const Census& a, const Census& b) const;
};

class Block : public tess::Chare<Block, BlockIndex> {
 public:
  /// Along the curve of paths, so that neighbours are mostly on one PE.
  static tess::PeId place(const BlockIndex& index, std::int32_t n_pes);

  void begin(Birth birth);
  void fill() { patch_.fill(0); }
  /// Steps first … first + n - 1.
  tess::Task advance(std::int32_t first, std::int32_t n);
  void receive_halo(Halo halo) { halos_.put(std::move(halo)); }
  void receive_flows(Flows flows) { flows_.put(std::move(flows)); }
  void plan() { choose(); }
  void hear(Choice of_neighbour);
  void change();
  void count(double time, const tess::Callback<Census>& result);

  [[nodiscard]] std::array<double, 3> balance_position() const { return patch_.low(); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(problem_, patch_, sides_, halos_, flows_, is_new_, has_chosen_, choice_, choices_);
  }

 private:
  [[nodiscard]] std::int32_t level() const { return index().level(); }
  [[nodiscard]] std::int32_t side(Face face) const {
    return sides_[static_cast<std::size_t>(face)];
  }
  /// Calls visit(index, quadrant of that leaf's face) for each leaf behind a face.
  template <class Visit>
  void for_neighbours(Face face, const Visit& visit) const;
  void send_halos(std::int32_t sweep, Face face) const;
  void choose();
  void tell() const;
  /// The level that will be behind a quarter of a face, relative to `own`.
  [[nodiscard]] std::int8_t relation(Face face, std::int32_t quadrant, std::int32_t own) const;

  Problem problem_;
  Patch patch_;
  Sides sides_{};
  tess::Mailbox<&Halo::sweep> halos_;
  tess::Mailbox<&Flows::sweep> flows_;
  bool is_new_ = true;
  bool has_chosen_ = false;
  std::int32_t choice_ = 0;
  std::array<std::array<std::int32_t, n_quadrants>, n_faces> choices_{};  // of neighbours
};

}  // namespace amr
