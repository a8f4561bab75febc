#include "m2m/couple/any_piece.hpp"

#include "m2m/couple/coupling_sides.hpp"
#include "m2m/couple/row_book.hpp"

#include <utility>

namespace tess::m2m {

std::span<const Status> AnyPiece::status(CouplingId id) const {
  return m2m_sides().with_target(id, [](const auto& to) { return to.status(); });
}
std::span<const double> AnyPiece::distance(CouplingId id) const {
  if (m2m_sides().is_conservative_target(id)) return {};
  return m2m_sides().target(id).distance();
}
const OutsidePolicy& AnyPiece::policy(CouplingId id) const {
  return *m2m_sides().with_target(id, [](const auto& to) { return &to.setup.policy; });
}

void AnyPiece::m2m_submit_source(const CouplingSetup& setup) {
  SourceSide& from = m2m_sides().sources[setup.id];
  from.setup = setup;
  setup.collider.submit_early({m2m_owner(), source_model, from.start_search(m2m_view())});
  m2m_sides().attached.erase(setup.id);
  if (from.has_kept_cover()) setup.ledger.local().add(Tally{.n_kept_sources = 1});
}
void AnyPiece::m2m_submit_target(const CouplingSetup& setup) {
  TargetSide& to = m2m_sides().targets[setup.id];
  to.setup = setup;
  setup.collider.submit_early({m2m_owner(), target_model, to.start_search(m2m_view())});
}
void AnyPiece::m2m_hits(CouplingId id, const collide::Hits& hits) {
  m2m_sides().with_target(id, [&](auto& to) { to.add(hits); });
}

void AnyPiece::m2m_ask(CouplingId id) {
  TargetSide& to = m2m_sides().target(id);
  for (auto& [source, query] : to.donor_queries(m2m_view()))
    m2m_send<&AnyPiece::m2m_answer>(to.setup.source, source, std::move(query));
  m2m_ask_on(to);
}
void AnyPiece::m2m_answer(DonorQuery query) {
  const CouplingId id = query.coupling;
  SourceSide& from = m2m_sides().source(id);
  // Behind the queries that are in the queue of this PE.
  if (from.add(std::move(query)))
    from.setup.source.send<&AnyPiece::m2m_answer_all>(m2m_owner(), id);
}
void AnyPiece::m2m_answer_all(CouplingId id) {
  SourceSide& from = m2m_sides().source(id);
  std::uint64_t n_tested = 0;
  for (auto& [target, answer] : from.answers(m2m_view(), n_tested))
    m2m_send<&AnyPiece::m2m_receive_donors>(from.setup.target, target, std::move(answer));
  from.setup.ledger.local().add(Tally{.n_candidates = n_tested});
}
void AnyPiece::m2m_receive_donors(const DonorAnswer& answer) {
  TargetSide& to = m2m_sides().target(answer.coupling);
  to.add(answer);
  m2m_ask_on(to);
}
void AnyPiece::m2m_name_source(CouplingId id) {
  const MeshView mesh = m2m_view();
  m2m_sides().source(id).setup.ledger.local().add(SourcePiece{
      m2m_owner(), box_of_nearest(mesh), static_cast<std::uint8_t>(mesh.points.empty() ? 0 : 1),
      static_cast<std::uint8_t>(mesh.tets.empty() ? 0 : 1)});
}
void AnyPiece::m2m_ask_nearest(CouplingId id, const std::vector<SourcePiece>& sources) {
  TargetSide& to = m2m_sides().target(id);
  if (!to.waits()) return;
  to.name_sources(m2m_view(), sources);
  m2m_ask_on(to);
}
void AnyPiece::m2m_answer_nearest(NearestQuery query) {
  SourceSide& from = m2m_sides().source(query.coupling);
  const collide::OwnerId target = query.from;
  m2m_send<&AnyPiece::m2m_receive_nearest>(from.setup.target, target,
                                           from.answer(m2m_view(), std::move(query)));
}
void AnyPiece::m2m_receive_nearest(const NearestAnswer& answer) {
  TargetSide& to = m2m_sides().target(answer.coupling);
  to.add(answer);
  m2m_ask_on(to);
}
void AnyPiece::m2m_choose(Choice choice) {
  m2m_sides().source(choice.coupling).choose(std::move(choice));
}

void AnyPiece::m2m_ask_on(TargetSide& to) {
  if (!to.has_all_answers()) return;
  if (to.needs_sources()) return to.setup.ledger.local().add_waiting();
  auto queries = to.nearest_queries(m2m_view());
  for (auto& [source, query] : queries)
    m2m_send<&AnyPiece::m2m_answer_nearest>(to.setup.source, source, std::move(query));
  if (!queries.empty()) return;
  for (auto& [source, choice] : to.choices(m2m_view()))
    m2m_send<&AnyPiece::m2m_choose>(to.setup.source, source, std::move(choice));
  to.setup.ledger.local().add(to.tally());
  to.setup.ledger.local().add(to.worst());
  if (is_alone(to)) to.setup.ledger.local().add_alone();
}
void AnyPiece::m2m_attach_if_alone(CouplingId id, collide::OwnerId source) {
  m2m_sides().with_target(id, [&](const auto& to) {
    if (is_alone(to)) to.setup.source.template send<&AnyPiece::m2m_attach>(source, id, m2m_owner());
  });
}
void AnyPiece::m2m_attach(CouplingId id, collide::OwnerId target) {
  m2m_sides().attached[id].push_back(target);
}

void AnyPiece::m2m_give_values(CouplingId id, detail::Giver give, detail::Taker take) {
  if (m2m_sides().is_conservative_source(id))
    return m2m_give_loads(id, give->show(*this, id), take);
  SourceSide& from = m2m_sides().source(id);
  const std::span<const double> values = give->show(*this, id);
  const MeshView mesh = m2m_view();
  const std::size_t n_rows = n_unknowns(mesh, from.setup.source_values);
  TESS_CHECK(n_rows == 0 || (!values.empty() && values.size() % n_rows == 0), "a piece with ",
             n_rows, " ", rows_of(from.setup.source_values), " gives ", values.size(),
             " values: give as many rows, ghosts included");
  from.give(mesh, values, take, [&](collide::OwnerId target, GivenValues given) {
    m2m_send<&AnyPiece::m2m_take>(from.setup.target, target, std::move(given));
  });
}
void AnyPiece::m2m_give_round(CouplingId id, detail::Giver give, detail::Taker take) {
  m2m_give_values(id, give, take);
  const auto at = m2m_sides().attached.find(id);
  if (at == m2m_sides().attached.end()) return;
  const PieceArray& targets = m2m_sides().targets_of(id);
  for (const collide::OwnerId target : at->second)
    targets.send<&AnyPiece::m2m_take_if_alone>(target, id, take);
}
void AnyPiece::m2m_take_if_alone(CouplingId id, detail::Taker take) {
  m2m_sides().with_target(id, [&](const auto& to) {
    if (to.n_sources() != 0) return;
    fill_outside(to.setup.policy, to.status(), take->show(*this, id));
    m2m_received(id);
  });
}
void AnyPiece::m2m_take(GivenValues given) {
  const CouplingId id = given.coupling;
  const detail::Taker take = given.take;
  if (m2m_sides().is_conservative_target(id)) {
    m2m_sides().overlap_target(id).add(std::move(given));
    return m2m_project(id, take);
  }
  TargetSide& to = m2m_sides().target(id);
  to.add(std::move(given));
  while (to.has_next(take->channel)) {
    to.take_next(take->channel, take->show(*this, id));
    m2m_received(id);
  }
}

void AnyPiece::m2m_give_rows(CouplingId id, GroupProxy<RowBook> book) {
  const MeshView mesh = m2m_view();
  SourceSide& from = m2m_sides().source(id);
  from.give_rows(mesh, [&](collide::OwnerId target, const Rows<double>& rows) {
    GivenRows given{id, {}, book, {}};
    for (std::size_t i = 0; i < rows.n_rows(); ++i)
      given.rows.sizes.push_back(rows.columns_of(i).size());
    for (const VertexId column : rows.columns)
      given.rows.columns.push_back(mesh.point_ids[static_cast<std::size_t>(column)]);
    given.rows.weights = rows.weights;
    m2m_send<&AnyPiece::m2m_take_rows>(from.setup.target, target, std::move(given));
  });
}
void AnyPiece::m2m_take_rows(GivenRows given) {
  const MeshView mesh = m2m_view();
  const TargetSide& to = m2m_sides().target(given.coupling);
  TESS_CHECK(mesh.n_owned == std::ssize(to.status()), "a piece owns ", mesh.n_owned,
             " points, and owned ", to.status().size(),
             " in the last search of the coupling: search again when points change");
  for (const std::int32_t row : to.rows_from(given.from))
    given.rows.targets.push_back(mesh.point_ids[static_cast<std::size_t>(row)]);
  given.book.local().add(given.rows);
}

void AnyPiece::m2m_release(CouplingId id) {
  m2m_sides().release(id);
}

}  // namespace tess::m2m
