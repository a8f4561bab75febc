// The entry methods of a piece for conservative couplings. The work is in OverlapSource and
// OverlapTarget.
//
//   step       at the source            message         at the target
//   ---------  -----------------------  --------------  --------------------------------------
//   submit     boxes of its cover       → collider ←    boxes of its cover; reports its points
//   hits                                                collects the source pieces near
//   ask                                 ← OverlapQuery  sends its tetrahedra there
//   answer     rows of weights          OverlapAnswer → adds up what is covered
//   share                               ← SharedRows    names the rows of several source pieces
//   part       gives these away         PartialRows →   adds them up
//   finish                                              masses; reports to the pieces beside it
//   give       loads                    GivenValues →   starts a projection
//   solve                                               GhostValues to and from pieces beside it
#pragma once

#include "m2m/parallel/couplings.hpp"

#include <utility>
#include <vector>

namespace tess::m2m {

template <class C>
class Piece;

template <class C>
class OverlapPiece {
 public:
  Couplings couplings;

  void m2m_submit_overlap_source(const CouplingSetup& setup) {
    OverlapSource& from = couplings.overlap_sources[setup.id];
    from.setup = setup;
    setup.collider.submit({me(), detail::source_model, from.start_search(chare().mesh_view())});
  }
  void m2m_submit_overlap_target(const CouplingSetup& setup) {
    OverlapTarget& to = couplings.overlap_targets[setup.id];
    to.setup = setup;
    const MeshView mesh = chare().mesh_view();
    setup.collider.submit({me(), detail::target_model, to.start_search(mesh)});
    if (setup.target_values != Centring::nodes) return;
    std::vector<std::vector<PointReport>> by_pe(static_cast<std::size_t>(n_pes()));
    for (const PointReport& report : to.point_reports(mesh, me()))
      by_pe[static_cast<std::size_t>(directory_pe(report.id, n_pes()))].push_back(report);
    for (std::int32_t pe = 0; pe < n_pes(); ++pe)
      if (auto& reports = by_pe[static_cast<std::size_t>(pe)]; !reports.empty())
        setup.directory[PeId{pe}].template send<&PointDirectory::add>(std::move(reports));
  }
  void m2m_share_points(CouplingId id, const SharedPoints& shared) {
    couplings.overlap_target(id).add(shared);
  }
  template <class S>
  void m2m_ask_overlaps(CouplingId id) {
    OverlapTarget& to = couplings.overlap_target(id);
    for (auto& [source, query] : to.queries(chare().mesh_view())) {
      query.from = me();
      detail::piece_of<S>(to.setup.source, source)
          .template send<&OverlapPiece<S>::template m2m_answer_overlaps<C>>(std::move(query));
    }
  }
  template <class T>
  void m2m_answer_overlaps(const OverlapQuery& query) {
    OverlapSource& from = couplings.overlap_source(query.coupling);
    OverlapAnswer answer = from.answer(chare().mesh_view(), query);
    answer.from = me();
    detail::piece_of<T>(from.setup.target, query.from)
        .template send<&OverlapPiece<T>::m2m_receive_overlaps>(std::move(answer));
  }
  void m2m_receive_overlaps(const OverlapAnswer& answer) {
    couplings.overlap_target(answer.coupling).add(answer);
  }
  template <class S>
  void m2m_share_rows(CouplingId id) {
    OverlapTarget& to = couplings.overlap_target(id);
    for (auto& [source, shared] : to.shared_rows()) {
      shared.from = me();
      detail::piece_of<S>(to.setup.source, source)
          .template send<&OverlapPiece<S>::template m2m_part<C>>(std::move(shared));
    }
  }
  template <class T>
  void m2m_part(const SharedRows& shared) {
    OverlapSource& from = couplings.overlap_source(shared.coupling);
    PartialRows partial = from.share(chare().mesh_view(), shared);
    partial.from = me();
    detail::piece_of<T>(from.setup.target, shared.from)
        .template send<&OverlapPiece<T>::m2m_receive_rows>(std::move(partial));
  }
  void m2m_receive_rows(PartialRows partial) {
    const CouplingId id = partial.coupling;
    couplings.overlap_target(id).add(std::move(partial));
  }
  void m2m_finish_search(CouplingId id) {
    OverlapTarget& to = couplings.overlap_target(id);
    for (const collide::OwnerId piece : to.finish_search(chare().mesh_view()))
      detail::piece_of<C>(to.setup.target, piece)
          .template send<&OverlapPiece<C>::m2m_greet>(id, me());
    to.setup.ledger.local().add(to.tally());
  }
  void m2m_greet(CouplingId id, collide::OwnerId neighbour) {
    couplings.overlap_target(id).add_neighbour(neighbour);
  }

  template <auto Take>
  void m2m_take_loads(GivenValues loads) {
    const CouplingId id = loads.coupling;
    couplings.overlap_target(id).add(std::move(loads));
    go_on<Take>(id);
  }
  template <auto Take>
  void m2m_take_ghosts(GhostValues ghosts) {
    const CouplingId id = ghosts.coupling;
    couplings.overlap_target(id).add(std::move(ghosts));
    go_on<Take>(id);
  }

 protected:
  [[nodiscard]] C& chare() { return static_cast<C&>(*this); }
  [[nodiscard]] collide::OwnerId me() { return collide::owner_of(chare().index()); }
  void notify(CouplingId id) {
    if constexpr (requires(C& of_user) { of_user.received(id); }) chare().received(id);
  }

  template <class T, auto Give, auto Take>
  void give_loads(CouplingId id) {
    OverlapSource& from = couplings.overlap_source(id);
    from.give(
        chare().mesh_view(), detail::values_of<Give>(chare(), id), detail::channel_of<Take>(),
        [&](collide::OwnerId target, GivenValues loads) {
          loads.from = me();
          detail::piece_of<T>(from.setup.target, target)
              .template send<&OverlapPiece<T>::template m2m_take_loads<Take>>(std::move(loads));
        });
  }
  template <auto Take>
  void take_if_alone(CouplingId id) {
    const OverlapTarget& to = couplings.overlap_target(id);
    if (to.n_sources() != 0) return;
    fill_outside(to.setup.policy, to.status(), detail::memory_of<Take>(chare(), id));
    notify(id);
  }

 private:
  friend Piece<C>;
  OverlapPiece() = default;

  template <auto Take>
  void go_on(CouplingId id) {
    OverlapTarget& to = couplings.overlap_target(id);
    const std::uint64_t channel = detail::channel_of<Take>();
    const auto send = [&](collide::OwnerId piece, GhostValues ghosts) {
      ghosts.from = me();
      detail::piece_of<C>(to.setup.target, piece)
          .template send<&OverlapPiece<C>::template m2m_take_ghosts<Take>>(std::move(ghosts));
    };
    while (to.advance(channel, send)) {
      to.write(channel, detail::memory_of<Take>(chare(), id));
      notify(id);
    }
  }
};

namespace detail {
template <class T>
void call_shared_points(const Callback<SharedPoints>& callback, SharedPoints&& shared) {
  const auto [target, coupling] =
      from_bytes<std::tuple<CollectionId, CouplingId>>(callback.where());
  piece_of<T>(target, shared.piece)
      .template send<&OverlapPiece<T>::m2m_share_points>(coupling, std::move(shared));
}
template <class T>
inline const Callback<SharedPoints>::Kind shared_points_kind{
    naming::name_of<&call_shared_points<T>>(), &call_shared_points<T>};
}  // namespace detail

}  // namespace tess::m2m
