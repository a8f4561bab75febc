// A piece of a mesh with a field that diffuses: a slab of planes x = const of a box of n³ cubes,
// each cut into six tetrahedra. The box may move; its field is then solved in the moving frame,
//
//     du/dt = κ Δu + v·∇u - R(u) + R(exact),   v the velocity of the box,
//
// with central differences and explicit Euler steps; the reaction R (reaction.hpp) is 0 unless
// asked for.
#pragma once

#include "apps/coupled/reaction.hpp"
#include "apps/kit/worst.hpp"
#include "m2m/coupling.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace coupled {

using tess::collide::Point;
using tess::m2m::CouplingId;

/// A box of n³ cubes, cut into slabs.
struct Box {
  Point low{};
  double edge = 1;
  std::int32_t n = 16;
  std::int32_t n_slabs = 4;
  /// The outermost nodes get their values from the other mesh, instead of 0 on the unit cube.
  bool has_fringe = false;
  /// Nodes take values from nodes of the other mesh that are at least as deep in its box.
  double least_depth = 0;
  Reaction reaction{};

  [[nodiscard]] double spacing() const { return edge / n; }
};

/// exp(-3π²κt) sin πx sin πy sin πz, with κ = 1: zero on the unit cube's faces.
[[nodiscard]] double exact(const Point& p, double time);

/// A step in time, and the velocity of the box in it.
struct Step {
  double time = 0;  ///< at its begin
  double dt = 0;
  Point velocity{};
};

/// What is known at the end.
struct Comparison {
  double error = 0;        ///< largest distance from exact()
  std::uint64_t hash = 0;  ///< of all values, in no order
  std::uint64_t n_taken = 0;
};
struct JoinComparisons {
  Comparison operator()(const Comparison& a, const Comparison& b) const {
    Comparison both{a.error, a.hash + b.hash, a.n_taken + b.n_taken};
    kit::worsen(both.error, b.error);
    return both;
  }
};

class Slab : public tess::Chare<Slab, tess::Index1>, public tess::m2m::Piece<Slab> {
 public:
  Slab() = default;
  explicit Slab(const Box& box);

  /// Sends the outer planes to the neighbours.
  void exchange();
  void step(const Step& by);
  void move_to(Point low);
  void compare(double time, tess::Callback<Comparison> result);

  // What the coupling calls: pairs (value, depth in the box) of all nodes, and those that arrive.
  [[nodiscard]] tess::m2m::MeshView mesh_view() const;
  [[nodiscard]] std::span<const double> give();
  [[nodiscard]] std::span<double> take() { return taken_; }
  void received(CouplingId coupling);

  void receive_plane(bool from_left, const std::vector<double>& values);

  /// The position for load balancing, in slabs.
  [[nodiscard]] std::array<double, 3> balance_position() const { return {double(index().x), 0, 0}; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, box_, first_, n_planes_, n_given_planes_, points_, tets_, point_ids_, tet_ids_,
       values_, left_, given_, taken_, n_taken_);
  }

 private:
  [[nodiscard]] std::int32_t side() const { return box_.n + 1; }
  [[nodiscard]] std::size_t plane() const {
    return static_cast<std::size_t>(side()) * static_cast<std::size_t>(side());
  }
  [[nodiscard]] std::size_t n_owned() const {
    return static_cast<std::size_t>(n_planes_) * plane();
  }
  /// The node's place in the box, in cubes.
  [[nodiscard]] std::array<std::int32_t, 3> place(std::size_t node) const;
  [[nodiscard]] bool is_outermost(std::size_t node) const;
  void diffuse(const Step& by);
  void react(const Step& by);
  void place_points();
  void cut_cubes();

  Box box_;
  std::int32_t first_ = 0;           // first plane owned
  std::int32_t n_planes_ = 0;        // planes owned
  std::int32_t n_given_planes_ = 0;  // and the next one, for the tetrahedra between
  std::vector<Point> points_;        // plane by plane
  std::vector<tess::m2m::Tet> tets_;
  std::vector<tess::m2m::GlobalId> point_ids_, tet_ids_;
  std::vector<double> values_;  // per point
  std::vector<double> left_;    // of the plane before the first; empty in the first slab
  std::vector<double> given_, taken_;
  std::uint64_t n_taken_ = 0;
};

}  // namespace coupled
