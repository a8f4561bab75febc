// A leaf of the oct-tree: a chare that exists while the field is as steep as its cells are fine.
//
// A step is three sweeps. In each a leaf sends layers of cells to the leaves behind two faces,
// awaits theirs, and moves the mass; a leaf beside finer ones awaits their flows as well. Two entry
// methods, each in an epoch of its own, change the tree:
//
//     plan    every leaf chooses a level by its own cells, and tells its neighbours; if it hears of a
//             level that raises its choice (neighbourhood.hpp) it tells them again. The end is the
//             epoch's.
//     change  a leaf that goes up sends an eighth of its cells to each of eight children, one that
//             goes down sends its cells to its parent; the first message creates them. Then it is
//             destroyed. All know the levels behind their faces from the messages of `plan`.
#pragma once

#include "apps/amr/neighbourhood.hpp"
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
/// What a new leaf begins with; `octant`: the part of it, or -1 for all.
struct Birth {
  Problem problem;
  std::int32_t octant = -1;
  Sides sides{};
  std::vector<Quanta> masses{};
};

class Block : public tess::Chare<Block, BlockIndex> {
 public:
  /// Along the curve of paths, so that neighbours are mostly on one PE.
  static tess::PeId place(const BlockIndex& index, std::int32_t n_pes) {
    return tess::PeId{static_cast<std::int32_t>(index.along() * n_pes)};
  }
  [[nodiscard]] std::array<double, 3> balance_position() const { return patch_.low(); }

  void begin(Birth birth);
  void fill() { patch_.fill(0); }
  /// Steps first … first + n - 1.
  tess::Task advance(std::int32_t first, std::int32_t n);
  void receive_halo(Halo halo) { halos_.put(std::move(halo)); }
  void receive_flows(Flows flows) { flows_.put(std::move(flows)); }
  void plan();
  void hear(const Choice& of_neighbour);
  void change();
  void count(double time, const tess::Callback<Census>& result);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(problem_, patch_, around_, halos_, flows_, is_new_);
  }

 private:
  void send_halos(std::int32_t sweep, Face face) const;
  void send_flows(std::int32_t sweep, Face face) const;
  void tell() const;
  /// Its part of the plane through the centre of the field, on the page of --monitor.
  void draw(double time) const;
  void split();
  void merge();

  Problem problem_;
  Patch patch_;
  Neighbourhood around_;
  tess::Mailbox<&Halo::sweep> halos_;
  tess::Mailbox<&Flows::sweep> flows_;
  bool is_new_ = true;
};

}  // namespace amr
