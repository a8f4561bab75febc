// The part of the library in a chare that holds a piece of a mesh: its entry methods, which receive
// the messages of searches and applications (messages.hpp), and the state of its couplings. The
// work is in SourceSide and TargetSide.
//
//   step       at the source            message         at the target
//   ---------  -----------------------  --------------  --------------------------------------
//   submit     boxes of its cover       → collider ←    boxes around its points
//   hits                                                collects the source pieces near
//   ask                                 ← DonorQuery    sends its points there
//   answer     locates the points       DonorAnswer →   keeps the best candidate of each
//   outside    its nearest vertex       ← NearestQuery  if the policy says so
//                                       NearestAnswer →
//   choose     keeps what was chosen    ← Choice        decides
//   give       interpolates             GivenValues →   writes a round that is complete
#pragma once

#include "m2m/parallel/overlap_piece.hpp"
#include "m2m/parallel/row_book.hpp"
#include "runtime/runtime.hpp"

#include <span>
#include <vector>

namespace tess::m2m {

/// A second base class of a chare that holds a piece of a mesh. The chare has a member function
/// `MeshView mesh_view() const`; if it migrates, it serialises `couplings`. If it has a member
/// function `received(CouplingId)`, that is called after new values were written.
template <class C>
class Piece : public OverlapPiece<C> {
 public:
  using OverlapPiece<C>::couplings;

  /// Where the points of this piece lie in the source of a coupling: per point owned.
  [[nodiscard]] std::span<const Status> status(CouplingId id) const {
    return couplings.is_conservative_target(id) ? couplings.overlap_target(id).status()
                                                : couplings.target(id).status();
  }

  /// How far the points of this piece lie from the source, in units of the mesh: per point owned. 0
  /// if inside or on the boundary; if snapped, from the tetrahedron; if outside, from the nearest
  /// vertex. Empty for conservative kinds.
  [[nodiscard]] std::span<const double> distance(CouplingId id) const {
    if (couplings.is_conservative_target(id)) return {};
    return couplings.target(id).distance();
  }

  /// The policy of a coupling whose target this piece belongs to.
  [[nodiscard]] const OutsidePolicy& policy(CouplingId id) const {
    return couplings.is_conservative_target(id) ? couplings.overlap_target(id).setup.policy
                                                : couplings.target(id).setup.policy;
  }

  /// Gives the values that Give returns to the pieces of the coupling's target, which are of class
  /// T: F of each is the memory that they go to. The k-th call of every source piece belongs to the
  /// k-th round; a target piece gets a round when it is complete. Give may be const.
  template <class T, auto Give, auto Take>
  void m2m_give(CouplingId id) {
    if (couplings.is_conservative_source(id)) return this->template give_loads<T, Give, Take>(id);
    SourceSide& from = couplings.source(id);
    const std::span<const double> values = detail::values_of<Give>(chare(), id);
    const MeshView mesh = chare().mesh_view();
    const std::size_t n_rows = n_unknowns(mesh, from.setup.source_values);
    TESS_CHECK(n_rows == 0 || values.size() % n_rows == 0, "a piece with ", n_rows, " ",
               rows_of(from.setup.source_values), " gives ", values.size(),
               " values: give as many rows, ghosts included");
    from.give(mesh, values, detail::channel_of<Take>(),
              [&](collide::OwnerId target, GivenValues given) {
                given.from = me();
                at<T>(from.setup.target, target)
                    .template send<&Piece<T>::template m2m_take<Take>>(std::move(given));
              });
  }
  /// A piece without sources has nothing to wait for.
  template <auto Take>
  void m2m_take_if_alone(CouplingId id) {
    if (couplings.is_conservative_target(id)) return this->template take_if_alone<Take>(id);
    const TargetSide& to = couplings.target(id);
    if (to.n_sources() != 0) return;
    fill_outside(to.setup.policy, to.status(), detail::memory_of<Take>(chare(), id));
    notify(id);
  }
  template <auto Take>
  void m2m_take(GivenValues rows) {
    const CouplingId id = rows.coupling;
    const std::uint64_t from = rows.channel;
    TargetSide& to = couplings.target(id);
    to.add(std::move(rows));
    while (to.has_next(from)) {
      to.take_next(from, detail::memory_of<Take>(chare(), id));
      notify(id);
    }
  }

  /// Gives the weights of the donors to the pieces of the coupling's target (coupling_weights.hpp).
  template <class T>
  void m2m_give_rows(CouplingId id, GroupProxy<RowBook> book) {
    const MeshView mesh = chare().mesh_view();
    SourceSide& from = couplings.source(id);
    from.give_rows(mesh, [&](collide::OwnerId target, const Rows<double>& rows) {
      GivenRows given{id, me(), book, {}};
      for (std::size_t i = 0; i < rows.n_rows(); ++i)
        given.rows.sizes.push_back(rows.columns_of(i).size());
      for (const VertexId column : rows.columns)
        given.rows.columns.push_back(mesh.point_ids[static_cast<std::size_t>(column)]);
      given.rows.weights = rows.weights;
      at<T>(from.setup.target, target).template send<&Piece<T>::m2m_take_rows>(std::move(given));
    });
  }
  void m2m_take_rows(GivenRows given) {
    const MeshView mesh = chare().mesh_view();
    for (const std::int32_t row : couplings.target(given.coupling).rows_from(given.from))
      given.rows.targets.push_back(mesh.point_ids[static_cast<std::size_t>(row)]);
    given.book.local().add(given.rows);
  }

  void m2m_submit_source(const CouplingSetup& setup) {
    SourceSide& from = couplings.sources[setup.id];
    from.setup = setup;
    const MeshView mesh = chare().mesh_view();
    setup.collider.submit_early({me(), detail::source_model, from.start_search(mesh)});
    if (from.has_kept_cover()) setup.ledger.local().add(Tally{.n_kept_sources = 1});
  }
  void m2m_submit_target(const CouplingSetup& setup) {
    TargetSide& to = couplings.targets[setup.id];
    to.setup = setup;
    setup.collider.submit_early({me(), detail::target_model, to.start_search(chare().mesh_view())});
  }
  void m2m_hits(CouplingId id, const collide::Hits& hits) {
    if (couplings.is_conservative_target(id))
      couplings.overlap_target(id).add(hits);
    else
      couplings.target(id).add(hits);
  }

  template <class S>
  void m2m_ask(CouplingId id) {
    TargetSide& to = couplings.target(id);
    for (auto& [source, query] : to.donor_queries(chare().mesh_view())) {
      query.from = me();
      at<S>(to.setup.source, source)
          .template send<&Piece<S>::template m2m_answer<C>>(std::move(query));
    }
    ask_on<S>(to);
  }
  template <class T>
  void m2m_answer(const DonorQuery& query) {
    SourceSide& from = couplings.source(query.coupling);
    DonorAnswer answer = from.answer(chare().mesh_view(), query);
    answer.from = me();
    at<T>(from.setup.target, query.from)
        .template send<&Piece<T>::template m2m_receive_donors<C>>(std::move(answer));
  }
  template <class S>
  void m2m_receive_donors(const DonorAnswer& answer) {
    TargetSide& to = couplings.target(answer.coupling);
    to.add(answer);
    ask_on<S>(to);
  }
  void m2m_name_source(CouplingId id) {
    const MeshView mesh = chare().mesh_view();
    couplings.source(id).setup.ledger.local().add(SourcePiece{
        me(), box_of_nearest(mesh), static_cast<std::uint8_t>(mesh.tets.empty() ? 0 : 1)});
  }
  template <class S>
  void m2m_ask_nearest(CouplingId id, const std::vector<SourcePiece>& sources) {
    TargetSide& to = couplings.target(id);
    if (!to.waits()) return;
    to.name_sources(chare().mesh_view(), sources);
    ask_on<S>(to);
  }
  template <class T>
  void m2m_answer_nearest(NearestQuery query) {
    SourceSide& from = couplings.source(query.coupling);
    const collide::OwnerId target = query.from;
    NearestAnswer answer = from.answer(chare().mesh_view(), std::move(query));
    answer.from = me();
    at<T>(from.setup.target, target)
        .template send<&Piece<T>::template m2m_receive_nearest<C>>(std::move(answer));
  }
  template <class S>
  void m2m_receive_nearest(const NearestAnswer& answer) {
    TargetSide& to = couplings.target(answer.coupling);
    to.add(answer);
    ask_on<S>(to);
  }
  void m2m_choose(Choice choice) { couplings.source(choice.coupling).choose(std::move(choice)); }

  void m2m_release(CouplingId id) { couplings.release(id); }

 protected:
  Piece() = default;

 private:
  using OverlapPiece<C>::chare;
  using OverlapPiece<C>::me;
  using OverlapPiece<C>::notify;
  template <class Other>
  [[nodiscard]] static auto at(CollectionId array, collide::OwnerId piece) {
    return detail::piece_of<Other>(array, piece);
  }
  /// Goes on with a search once all answers are there.
  template <class S>
  void ask_on(TargetSide& to) {
    if (!to.has_all_answers()) return;
    if (to.needs_sources()) return to.setup.ledger.local().add_waiting();
    auto queries = to.nearest_queries(chare().mesh_view());
    for (auto& [source, query] : queries) {
      query.from = me();
      at<S>(to.setup.source, source)
          .template send<&Piece<S>::template m2m_answer_nearest<C>>(std::move(query));
    }
    if (!queries.empty()) return;
    for (auto& [source, choice] : to.choices(chare().mesh_view())) {
      choice.from = me();
      at<S>(to.setup.source, source).template send<&Piece<S>::m2m_choose>(std::move(choice));
    }
    to.setup.ledger.local().add(to.tally());
    to.setup.ledger.local().add(to.worst());
  }
};

namespace detail {
template <class T>
void call_target(const Callback<collide::Hits>& callback, collide::Hits&& hits) {
  const auto [target, coupling] =
      from_bytes<std::tuple<CollectionId, CouplingId>>(callback.where());
  piece_of<T>(target, hits.owner).template send<&Piece<T>::m2m_hits>(coupling, std::move(hits));
}
template <class T>
inline const Callback<collide::Hits>::Kind target_kind{naming::name_of<&call_target<T>>(),
                                                       &call_target<T>};
}  // namespace detail

}  // namespace tess::m2m
