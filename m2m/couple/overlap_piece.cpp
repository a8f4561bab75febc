// The entry methods of a piece for conservative couplings.
#include "m2m/couple/any_piece.hpp"
#include "m2m/couple/coupling_sides.hpp"

#include <utility>
#include <vector>

namespace tess::m2m {

void AnyPiece::m2m_submit_overlap_source(const CouplingSetup& setup) {
  OverlapSource& from = m2m_sides().overlap_sources[setup.id];
  from.setup = setup;
  setup.collider.submit({m2m_owner(), source_model, from.start_search(m2m_view())});
  m2m_sides().attached.erase(setup.id);
  setup.ledger.local().add_source(m2m_owner());
}
void AnyPiece::m2m_submit_overlap_target(const CouplingSetup& setup) {
  OverlapTarget& to = m2m_sides().overlap_targets[setup.id];
  to.setup = setup;
  const MeshView mesh = m2m_view();
  setup.collider.submit({m2m_owner(), target_model, to.start_search(mesh)});
  if (setup.target_values != Centring::nodes) return;
  std::vector<std::vector<PointReport>> by_pe(static_cast<std::size_t>(n_pes()));
  for (const PointReport& report : to.point_reports(mesh, m2m_owner()))
    by_pe[static_cast<std::size_t>(directory_pe(report.id, n_pes()))].push_back(report);
  for (std::int32_t pe = 0; pe < n_pes(); ++pe)
    if (auto& reports = by_pe[static_cast<std::size_t>(pe)]; !reports.empty())
      setup.directory[PeId{pe}].send<&PointDirectory::add>(std::move(reports));
}
void AnyPiece::m2m_share_points(CouplingId id, const SharedPoints& shared) {
  m2m_sides().overlap_target(id).add(shared);
}

void AnyPiece::m2m_ask_overlaps(CouplingId id) {
  OverlapTarget& to = m2m_sides().overlap_target(id);
  for (auto& [source, query] : to.queries(m2m_view()))
    m2m_send<&AnyPiece::m2m_answer_overlaps>(to.setup.source, source, std::move(query));
}
void AnyPiece::m2m_answer_overlaps(const OverlapQuery& query) {
  OverlapSource& from = m2m_sides().overlap_source(query.coupling);
  m2m_send<&AnyPiece::m2m_receive_overlaps>(from.setup.target, query.from,
                                            from.answer(m2m_view(), query));
}
void AnyPiece::m2m_receive_overlaps(const OverlapAnswer& answer) {
  m2m_sides().overlap_target(answer.coupling).add(answer);
}

void AnyPiece::m2m_share_rows(CouplingId id) {
  OverlapTarget& to = m2m_sides().overlap_target(id);
  for (auto& [source, shared] : to.shared_rows())
    m2m_send<&AnyPiece::m2m_part>(to.setup.source, source, std::move(shared));
}
void AnyPiece::m2m_part(const SharedRows& shared) {
  OverlapSource& from = m2m_sides().overlap_source(shared.coupling);
  m2m_send<&AnyPiece::m2m_receive_rows>(from.setup.target, shared.from,
                                        from.share(m2m_view(), shared));
}
void AnyPiece::m2m_receive_rows(PartialRows partial) {
  const CouplingId id = partial.coupling;
  m2m_sides().overlap_target(id).add(std::move(partial));
}

void AnyPiece::m2m_finish_search(CouplingId id) {
  OverlapTarget& to = m2m_sides().overlap_target(id);
  for (const collide::OwnerId piece : to.finish_search(m2m_view()))
    to.setup.target.send<&AnyPiece::m2m_greet>(piece, id, m2m_owner());
  to.setup.ledger.local().add(to.tally());
  if (is_alone(to)) to.setup.ledger.local().add_alone();
}
void AnyPiece::m2m_greet(CouplingId id, collide::OwnerId neighbour) {
  m2m_sides().overlap_target(id).add_neighbour(neighbour);
}

void AnyPiece::m2m_give_loads(CouplingId id, std::span<const double> values, detail::Taker take) {
  OverlapSource& from = m2m_sides().overlap_source(id);
  from.give(m2m_view(), values, take, [&](collide::OwnerId target, GivenValues loads) {
    m2m_send<&AnyPiece::m2m_take>(from.setup.target, target, std::move(loads));
  });
}
void AnyPiece::m2m_take_ghosts(GhostValues ghosts) {
  const CouplingId id = ghosts.coupling;
  const detail::Taker take = ghosts.take;
  m2m_sides().overlap_target(id).add(std::move(ghosts));
  m2m_project(id, take);
}
void AnyPiece::m2m_project(CouplingId id, detail::Taker take) {
  OverlapTarget& to = m2m_sides().overlap_target(id);
  const auto send = [&](collide::OwnerId piece, GhostValues ghosts) {
    m2m_send<&AnyPiece::m2m_take_ghosts>(to.setup.target, piece, std::move(ghosts));
  };
  while (to.advance(take, send)) {
    to.write(take->channel, take->show(*this, id));
    m2m_received(id);
  }
}

}  // namespace tess::m2m
