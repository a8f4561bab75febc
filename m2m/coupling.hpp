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
// times. Search again if a mesh moves or changes, and if pieces are inserted or destroyed: before
// that, a target piece waits for the values of a source piece that is gone, and keeps its own.
// Values travel from piece to piece; no PE collects them. Any
// number of couplings may exist and be in flight. A piece may be source and target of several. The
// arrays have one to three dimensions, dense or sparse.
//
// apply() is a broadcast to the source pieces in an epoch. Pieces can also start on their own,
// without the main coroutine: a source piece calls its m2m_give() when its values are ready, and a
// target piece's received() is called when all of its rows are there.
//
// Kinds with gradients need a halo of two layers of tetrahedra around each source piece, conservative
// kinds one around each target piece (MeshView::n_own_tets, transfer_kind.hpp), so that the result
// does not depend on how the mesh is cut.
//
// Conservative kinds also take and give values in cells (CouplingOptions::source_values): cells get
// the mean of the source over what it covers of them. Their status is `inside` if the source covers
// the cell, or all cells around the point, `snapped` if it covers them in part, otherwise `outside`.
//
// The result depends only on the meshes and the fields: not on the number of PEs or pieces, the
// voxels, or the order of messages.
#pragma once

#include "m2m/parallel/piece.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <concepts>
#include <functional>
#include <utility>

namespace tess::m2m {

struct CouplingOptions {
  Point voxel_origin{0, 0, 0};
  Point voxel_size{0, 0, 0};      ///< zero: chosen
  OutsidePolicy policy = Keep{};  ///< for target points outside the source; Nearest if `kind` is
  TransferKind kind = TransferKind::linear;
  /// A point outside that is at most so far from a tetrahedron, in units of the mesh, snaps to the
  /// nearest one. Its value is that of the nearest point there. Kinds that are not conservative.
  double tolerance = 0;
  /// Keeps values within those of the vertices of the donor. It matters for points that snap within
  /// rounding, whose values extrapolate, and for second_order, which then is `limited`.
  bool clamp = false;
  /// What the values belong to. Sources: anything for linear and conservative kinds, nodes for the
  /// others. Targets: nodes, or cells for conservative kinds.
  Centring source_values = Centring::nodes;
  Centring target_values = Centring::nodes;
  /// Called with the name of each phase ("broad", "narrow") when it starts; may be empty.
  std::function<void(const char*)> on_phase{};
};

namespace detail {
/// What a handle has started that is not done; a copy of the handle has started nothing.
struct UnderWay {
  int n_searches = 0, n_applications = 0;

  UnderWay() = default;
  UnderWay(const UnderWay& /*of_another_handle*/) {}
  UnderWay& operator=(const UnderWay& /*of_another_handle*/) { return *this; }
};
/// One of them, while it lives.
class Counted {
 public:
  explicit Counted(int& n) : n_(n) { ++n_; }
  ~Counted() { --n_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  int& n_;
};

template <class C>
concept IsPiece = std::derived_from<C, Piece<C>> && requires(const C& chare) {
  { chare.mesh_view() } -> std::same_as<MeshView>;
};
}  // namespace detail

/// Times and counts of a search. Times are wall-clock seconds on the calling PE.
struct SearchSummary {
  double broad = 0;   ///< covers, voxels, pairs of pieces that are near
  double narrow = 0;  ///< point location, points outside
  Tally tally;        ///< of the target points
  WorstPlaces worst;  ///< of the target points that are snapped or outside
};

/// A coupling from an array of S to an array of T, which are Pieces. A handle: it can be copied.
template <class S, class T>
class Coupling {
 public:
  Coupling() = default;
  Coupling(ArrayProxy<S> source, ArrayProxy<T> target, CouplingOptions options = {})
      : source_(source), target_(target), options_(std::move(options)) {
    if (options_.kind == TransferKind::nearest) options_.policy = Nearest{};
    if (options_.kind == TransferKind::second_order && options_.clamp)
      options_.kind = TransferKind::limited;
  }

  /// Valid after the first search.
  [[nodiscard]] CouplingId id() const { return setup_.id; }
  /// For what is built on couplings, such as coupling_weights.hpp. Valid after the first search.
  [[nodiscard]] const CouplingSetup& setup() const { return setup_; }

  /// Finds the donors. The pieces and their coordinates stay as they are until it is done, and no
  /// other search and no application of this coupling is under way. `summary` may be null.
  Task search(SearchSummary* summary = nullptr);

  /// Gives the field that Give shows to the memory that Take shows, for example
  /// apply<&Fluid::temperature, &Solid::heat>(). When the task is done, all target pieces have it.
  ///   Give: std::span<const double> S::f() const, n_points × n_components, ghosts included; if
  ///     source_values are cells, a row per tetrahedron, or four if they are corners
  ///   Take: std::span<double> T::g(), n_owned × n_components; points without a donor keep theirs;
  ///     if target_values are cells, a row per own tetrahedron
  /// Each may take the CouplingId. Each may also be a public std::vector<double>, such as &S::field.
  template <auto Give, auto Take>
  Task apply();

  /// Frees what the pieces and PEs hold of this coupling; a search makes it again. The enclosing
  /// epoch includes this. No search and no application of it is under way. Arrays of pieces are
  /// destroyed in a later epoch.
  void destroy() {
    TESS_CHECK(under_way_.n_searches == 0 && under_way_.n_applications == 0,
               "a coupling is destroyed while a search or an application of it is under way: "
               "co_await that first");
    if (setup_.id == CouplingId{}) return;
    source_.template broadcast<&Piece<S>::m2m_release>(setup_.id);
    target_.template broadcast<&Piece<T>::m2m_release>(setup_.id);
    setup_.collider.destroy();
    setup_.ledger.destroy();
    if (has_directory()) setup_.directory.destroy();
    setup_ = {};
  }

 private:
  [[nodiscard]] bool is_conservative() const { return m2m::is_conservative(options_.kind); }
  /// The pieces of the target exchange values of ghosts.
  [[nodiscard]] bool has_directory() const {
    return is_conservative() && options_.target_values == Centring::nodes;
  }
  /// Throws Error (bad_argument) if options contradict each other.
  void check_options() const;
  /// Creates what the search needs on all PEs.
  void set_up();
  Task collide_covers();
  Task find_donors(LedgerPage& found);
  /// Gives what the pieces have added to the ledger since the last call.
  Task close_page(LedgerPage& page);
  Task find_overlaps();
  void enter(const char* phase) const {
    if (options_.on_phase) options_.on_phase(phase);
  }

  ArrayProxy<S> source_;
  ArrayProxy<T> target_;
  CouplingOptions options_;
  CouplingSetup setup_;
  detail::UnderWay under_way_;
};

template <class S, class T>
Task Coupling<S, T>::search(SearchSummary* summary) {
  static_assert(detail::IsPiece<S> && detail::IsPiece<T>,
                "a chare of a coupling derives from tess::m2m::Piece<of itself>, and has a public "
                "member function MeshView mesh_view() const");
  static_assert(collide::CanOwn<typename S::Index> && collide::CanOwn<typename T::Index>,
                "the pieces of a coupling are elements of arrays of one to three dimensions");
  TESS_CHECK(under_way_.n_searches == 0 && under_way_.n_applications == 0,
             "a coupling searches while a search or an application of it is under way: co_await "
             "that first");
  detail::require_usable(setup_, source_.id(), target_.id(), "searched");
  const detail::Counted counted(under_way_.n_searches);
  enter("broad");
  const Time start = now();
  co_await collide_covers();
  const Time broad = now();
  enter("narrow");
  LedgerPage found;
  if (is_conservative()) {
    co_await find_overlaps();
    co_await close_page(found);
  } else {
    co_await find_donors(found);
  }
  if (summary != nullptr)
    *summary = {seconds(broad - start), seconds(now() - broad), found.tally, found.worst};
}

template <class S, class T>
Task Coupling<S, T>::close_page(LedgerPage& page) {
  Future<LedgerPage> closed;
  setup_.ledger.template broadcast<&Ledger::close_page>(closed.callback());
  page = co_await closed;
}

template <class S, class T>
void Coupling<S, T>::check_options() const {
  if (!(options_.tolerance >= 0 && options_.tolerance <= 1e100))
    fail(ErrorCode::bad_argument, "tolerance ", options_.tolerance,
         " is not a length; choose 0 to 1e100 in units of the mesh");
  if (is_conservative()) {
    if (options_.tolerance > 0 || options_.clamp)
      fail(ErrorCode::bad_argument, "kind ", name_of(options_.kind),
           " has no donors: tolerance and clamp are for kinds that interpolate");
    if (std::holds_alternative<Nearest>(options_.policy))
      fail(ErrorCode::bad_argument,
           "a conservative kind has no nearest vertex for what the source does not cover: choose "
           "policy keep or value");
    if (options_.target_values == Centring::corners)
      fail(ErrorCode::bad_argument,
           "target values at corners are not offered: choose nodes or cells");
    return;
  }
  if (options_.target_values != Centring::nodes)
    fail(ErrorCode::bad_argument, "kind ", name_of(options_.kind),
         " gives values at points: show the centroids of the cells as the target's points, or "
         "choose a conservative kind for target values in cells");
  if (options_.source_values == Centring::nodes) return;
  if (options_.kind != TransferKind::linear)
    fail(ErrorCode::bad_argument, "kind ", name_of(options_.kind),
         " takes values at nodes: choose linear or a conservative kind for source values in cells "
         "or at their corners");
  if (std::holds_alternative<Nearest>(options_.policy))
    fail(
        ErrorCode::bad_argument, "kind ", name_of(options_.kind),
        " with source values in cells has no nearest vertex for points outside: choose policy keep "
        "or value, or a tolerance");
}

template <class S, class T>
void Coupling<S, T>::set_up() {
  setup_.source = source_.id();
  setup_.target = target_.id();
  setup_.policy = options_.policy;
  setup_.kind = options_.kind;
  setup_.tolerance = options_.tolerance;
  setup_.clamp = options_.clamp;
  setup_.source_values = options_.source_values;
  setup_.target_values = options_.target_values;
  setup_.collider = collide::make_collider({options_.voxel_origin, options_.voxel_size, {}});
  setup_.ledger = create_group<Ledger>();
  if (has_directory()) setup_.directory = create_group<PointDirectory>();
  // Each coupling has its own collider.
  setup_.id = CouplingId{setup_.collider.voxels.id().value};
}

template <class S, class T>
Task Coupling<S, T>::collide_covers() {
  const bool is_new = setup_.id == CouplingId{};
  if (is_new) check_options();
  // The pieces of conservative kinds call the directory, which must be known on their PEs.
  if (is_new && is_conservative()) co_await epoch([&] { set_up(); });
  co_await epoch([&] {
    if (is_new && !is_conservative()) set_up();
    if (is_conservative()) {
      source_.template broadcast<&Piece<S>::m2m_submit_overlap_source>(setup_);
      target_.template broadcast<&Piece<T>::m2m_submit_overlap_target>(setup_);
    } else {
      source_.template broadcast<&Piece<S>::m2m_submit_source>(setup_);
      target_.template broadcast<&Piece<T>::m2m_submit_target>(setup_);
    }
  });
  // Named, because g++ 12 destroys an aggregate twice if it is written in a co_await expression.
  const collide::Report to_target{
      Callback<collide::Hits>(detail::target_kind<T>,
                              to_bytes(std::tuple(target_.id(), setup_.id))),
      detail::target_model};
  co_await collide::run_collision(setup_.collider, to_target);
}

/// Only points that are in no tetrahedron need to know all source pieces.
template <class S, class T>
Task Coupling<S, T>::find_donors(LedgerPage& found) {
  co_await epoch([&] { target_.template broadcast<&Piece<T>::template m2m_ask<S>>(setup_.id); });
  co_await close_page(found);
  if (found.n_waiting == 0) co_return;
  co_await epoch([&] { source_.template broadcast<&Piece<S>::m2m_name_source>(setup_.id); });
  LedgerPage page;
  co_await close_page(page);
  std::sort(page.sources.begin(), page.sources.end(),
            [](const SourcePiece& a, const SourcePiece& b) { return a.owner < b.owner; });
  co_await epoch([&] {
    target_.template broadcast<&Piece<T>::template m2m_ask_nearest<S>>(setup_.id, page.sources);
  });
  co_await close_page(page);
  found += page;
}

/// Each step needs all messages of the one before.
template <class S, class T>
Task Coupling<S, T>::find_overlaps() {
  if (has_directory()) {
    co_await epoch([&] {
      setup_.directory.template broadcast<&PointDirectory::resolve>(Callback<SharedPoints>(
          detail::shared_points_kind<T>, to_bytes(std::tuple(target_.id(), setup_.id))));
    });
  }
  co_await epoch(
      [&] { target_.template broadcast<&Piece<T>::template m2m_ask_overlaps<S>>(setup_.id); });
  co_await epoch(
      [&] { target_.template broadcast<&Piece<T>::template m2m_share_rows<S>>(setup_.id); });
  co_await epoch([&] { target_.template broadcast<&Piece<T>::m2m_finish_search>(setup_.id); });
}

template <class S, class T>
template <auto Give, auto Take>
Task Coupling<S, T>::apply() {
  TESS_CHECK(setup_.id != CouplingId{},
             "a coupling is applied before its first search: "
             "co_await search() first");
  TESS_CHECK(under_way_.n_searches == 0,
             "a coupling is applied while a search of it is under way: co_await that first");
  detail::require_usable(setup_, source_.id(), target_.id(), "applied");
  const detail::Counted counted(under_way_.n_applications);
  const CouplingId id = setup_.id;
  co_await epoch([&] {
    source_.template broadcast<&Piece<S>::template m2m_give<T, Give, Take>>(id);
    target_.template broadcast<&Piece<T>::template m2m_take_if_alone<Take>>(id);
  });
}

}  // namespace tess::m2m
