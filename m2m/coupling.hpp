// Moves fields between the meshes of two arrays of chares. The chares are the application's own:
// each holds a piece of its mesh, shows it as spans, and gets values in its own memory.
//
// Sample: tests/samples/coupling.cpp
//
//     class Fluid : public tess::Chare<Fluid, tess::Index1>, public tess::m2m::Piece<Fluid> {
//      public:
//       tess::m2m::MeshView mesh_view() const { return mesh_.view(); }
//       std::span<const double> temperature() const { return temperature_; }
//       // …
//     class Solid : public tess::Chare<Solid, tess::Index2>, public tess::m2m::Piece<Solid> {
//      public:
//       tess::m2m::MeshView mesh_view() const { return mesh_.view(); }
//       std::span<double> heat() { return heat_; }
//       void received(tess::m2m::CouplingId coupling) { n_outside_ += count_outside(coupling); }
//       // …
//       tess::m2m::Coupling to_solid(fluid, solid);
//       co_await to_solid.search();
//       for (int step = 1; step <= 10; ++step) {
//         co_await tess::epoch([&] { fluid.broadcast<&Fluid::step>(step); });
//         co_await to_solid.apply<&Fluid::temperature, &Solid::heat>();
//       }
//
// A search finds the donors of every target point, once; apply() moves a field, any number of
// times. Search again after every motion: nothing notices an old search, and values come from the
// old donors. Search also if pieces are inserted or destroyed, or have other numbers of points or
// tetrahedra: apply() ends the job if a piece is new, a source piece is gone, or a number differs.
// Values travel from piece to piece; no PE collects them. Any number of couplings may exist and be
// in flight. A piece may be source and target of several. The arrays have one to three dimensions,
// dense or sparse.
//
// apply() is a broadcast to the source pieces in an epoch. Pieces can also start on their own,
// without the main coroutine: a source piece calls its m2m_give() when its values are ready, and a
// target piece's received() is called when all of its rows are there.
//
// Kinds with gradients need a halo of two layers of tetrahedra around each source piece,
// conservative kinds one around each target piece (MeshView::n_own_tets, transfer_kind.hpp), so
// that the result does not depend on how the mesh is cut.
//
// Conservative kinds also take and give values in cells (CouplingOptions::source_values): cells get
// the mean of the source over what it covers of them. Their status is `inside` if the source covers
// the cell, or all cells around the point, `snapped` if it covers them in part, otherwise
// `outside`.
//
// A mesh of triangles or edges (MeshView::dimension) couples likewise, by kinds without
// gradients (guide/surfaces.md).
//
// Nodal forces go back by the transposed rows, so that their sum, and with linear rows that of their
// moments, stays as it is to rounding. One search serves both:
//
// Sample: tests/m2m/couple/transposed_test.cpp
//
//     Coupling displacements(structure, wall, {.policy = Nearest{}});
//     co_await displacements.search();
//     Coupling forces = displacements.transposed();  // from the wall to the structure
//     co_await forces.search();                      // no geometry: the donors are those found above
//
// A coupling can be a member of the state of a checkpoint. After the restart, on any number of PEs,
// it applies without a search, with the bits of the run that was not interrupted.
//
// The result depends only on the meshes and the fields: not on the number of PEs or pieces, the
// voxels, or the order of messages.
#pragma once

#include "m2m/couple/piece.hpp"
#include "m2m/couple/piece_array.hpp"
#include "m2m/tally.hpp"
#include "m2m/transfer_kind.hpp"
#include "m2m/worst_places.hpp"

#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

namespace tess::collide {
struct Collider;
}  // namespace tess::collide

namespace tess::m2m {

struct CouplingOptions {
  Point voxel_size{0, 0, 0};  ///< zero: chosen
  /// For target points outside the source: Keep or UseValue with conservative kinds. With kind
  /// nearest, Keep is Nearest.
  OutsidePolicy policy = Keep{};
  TransferKind kind = TransferKind::linear;
  /// A point outside that is at most so far from a cell, in units of the mesh, snaps to the nearest
  /// one. Its value is that of the nearest point there. 0 with kind projection: however far it is.
  /// Conservative kinds: how far triangles that overlap may be apart, besides rounding.
  double tolerance = 0;
  Facing facing = Facing::either;  ///< of triangles, for conservative kinds
  /// Keeps values within those of the vertices of the donor, or of the neighbours. It matters for
  /// points that snap within rounding, whose values extrapolate, for moving least squares, and for
  /// second_order, which then is `limited`. Kinds that are not conservative.
  bool clamp = false;
  std::int32_t order = 1;  ///< of the polynomials of moving least squares: 1 or 2
  /// What the values belong to. Sources: anything for linear, projection and conservative kinds,
  /// nodes for the others. Targets: nodes, or cells for conservative kinds.
  Centring source_values = Centring::nodes;
  Centring target_values = Centring::nodes;
  /// Called with the name of each phase ("broad", "narrow") when it starts; may be null. It outlives
  /// the coupling; after a restart it is null.
  const std::function<void(const char*)>* on_phase = nullptr;
};
static_assert(std::is_trivially_destructible_v<CouplingOptions>,
              "g++ 12 destroys an aggregate twice that is written in a co_await expression");

/// Throws Error (bad_argument) if options contradict each other. The first search does that, too.
void check(const CouplingOptions& options);

/// Times and counts of a search. Times are wall-clock seconds on the calling PE.
struct SearchSummary {
  double broad = 0;   ///< covers, voxels, pairs of pieces that are near
  double narrow = 0;  ///< point location, points outside
  Tally tally;        ///< of the target points
  WorstPlaces worst;  ///< of the target points that are snapped or outside
};

/// What a transposed coupling does if points that give forces have no donor.
enum class LostForces : std::uint8_t {
  refuse,  ///< search() throws Error (bad_mesh) with their number
  allow,   ///< their forces are left out; Tally::n_lost counts the points
};

struct CouplingSetup;
struct LedgerPage;

/// A coupling between arrays of any class: what does not depend on that. A handle: it can be
/// copied, and saved.
class AnyCoupling {
 public:
  AnyCoupling();
  AnyCoupling(const AnyCoupling& other);
  AnyCoupling& operator=(const AnyCoupling& other);
  ~AnyCoupling();

  /// Valid after the first search.
  [[nodiscard]] CouplingId id() const;
  /// Finds the pieces that are near (collide/collider.hpp). Valid after the first search.
  [[nodiscard]] const collide::Collider& collider() const;
  /// For what uses the donors, such as coupling_weights.hpp. After the first search, while no other
  /// one is under way.
  [[nodiscard]] const CouplingSetup& setup() const;

  /// Finds the donors. The pieces and their coordinates stay as they are until it is done, and no
  /// other search and no application of this coupling is under way.
  TaskOf<SearchSummary> search();

  /// Frees what the pieces and PEs hold of this coupling; a search makes it again. The enclosing
  /// epoch includes this. No search and no application of it is under way. Arrays of pieces are
  /// destroyed in a later epoch.
  void destroy();

  /// For checkpoints. CouplingOptions::on_phase is not saved.
  template <class Ar>
  void serialize(Ar& ar);

 protected:
  AnyCoupling(PieceArray source, PieceArray target, CouplingOptions options);
  /// The transposed of `forth`.
  AnyCoupling(const AnyCoupling& forth, LostForces lost);
  Task apply(detail::Giver give, detail::Taker take, std::function<void(CouplingId)> last);

 private:
  struct State;

  Task collide_covers();
  TaskOf<LedgerPage> find_sources();
  Task pass_rows() const;

  std::unique_ptr<State> state_;
};

/// A coupling from an array of S to an array of T, which are Pieces. A handle: it can be copied.
template <class S, class T>
class Coupling : public AnyCoupling {
 public:
  Coupling() = default;
  Coupling(ArrayProxy<S> source, ArrayProxy<T> target, CouplingOptions options = {})
      : AnyCoupling(PieceArray(source), PieceArray(target), std::move(options)) {}

  TaskOf<SearchSummary> search() {
    static_assert(detail::check_piece<S>() && detail::check_piece<T>());
    return AnyCoupling::search();
  }

  /// Gives the field that Give shows to the memory that Take shows, for example
  /// apply<&Fluid::temperature, &Solid::heat>(). When the task is done, all target pieces have it.
  /// Applications to the same Take run one after the other, in the order of the calls. `last` runs
  /// in an epoch of its own before the next one begins. What received() or `last` causes must not
  /// start another one to the same Take: neither would end, and a check ends the job (not if the
  /// call stands in an epoch that received() opened).
  ///   Give: std::span<const double> S::f() const, n_points × n_components, ghosts included; if
  ///     source_values are cells, a row per tetrahedron, or four if they are corners
  ///   Take: std::span<double> T::g(), n_owned × n_components; points without a donor keep theirs;
  ///     if target_values are cells, a row per own tetrahedron
  /// Each may take the CouplingId. Each may also be a public std::vector<double>, such as
  /// &S::field.
  template <auto Give, auto Take>
  Task apply(std::function<void(CouplingId)> last = {}) {
    return AnyCoupling::apply(detail::Giver(detail::GiverOf<S, Give>::kind),
                              detail::Taker(detail::TakerOf<T, Take>::kind), std::move(last));
  }

  /// The coupling from T to S by the transposed rows of the last search of this one: a point that S
  /// owns gets the sum, over the points of T, of weight × value. For values that are forces at
  /// points. S takes n_owned × n_components, and 0 where no row is; T gives a row per point.
  ///
  /// It has its own search(), which looks at no geometry, and follows each search of this coupling.
  /// It is valid until this coupling is destroyed. The status of a point of S is `inside` if it
  /// gets forces, otherwise `outside`. Each point of T, and of S, is owned by one piece (view_of()
  /// for a MeshPiece). Not before the first search. Throws Error (bad_argument) if the kind has no
  /// weights (coupling_weights.hpp), or values are clamped or not in nodes.
  [[nodiscard]] Coupling<T, S> transposed(LostForces lost = LostForces::refuse) const {
    return Coupling<T, S>(*this, lost);
  }

 private:
  template <class, class>
  friend class Coupling;
  Coupling(const AnyCoupling& forth, LostForces lost) : AnyCoupling(forth, lost) {}
};

}  // namespace tess::m2m
