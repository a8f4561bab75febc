#include "m2m/couple/any_piece.hpp"

#include "m2m/couple/integral_book.hpp"
#include "m2m/couple/row_book.hpp"
#include "m2m/couple/source_side.hpp"
#include "m2m/couple/target_side.hpp"

#include <utility>

namespace tess::m2m {
namespace {

void check_points(const MeshView& mesh, const TargetFound& found) {
  TESS_CHECK(mesh.n_owned == std::ssize(found.status), "a piece owns ", mesh.n_owned,
             " points, and owned ", found.status.size(),
             " in the last search of the coupling: search again when points change");
}

}  // namespace

std::span<const Status> AnyPiece::status(CouplingId id) const {
  return couplings.target(id).found().status;
}
std::span<const double> AnyPiece::distance(CouplingId id) const {
  return couplings.target(id).found().distance;
}
std::span<const std::int8_t> AnyPiece::side(CouplingId id) const {
  return couplings.target(id).found().side;
}
const OutsidePolicy& AnyPiece::policy(CouplingId id) const {
  return couplings.target(id).setup.policy;
}

void AnyPiece::m2m_submit(const CouplingSetup& setup, collide::ModelId side) {
  const MeshView mesh = m2m_view();
  if (side == source_model) {
    SourceSide& from = couplings.add_source(setup.id);
    from.setup = setup;
    std::vector<Aabb> boxes = from.start_search(mesh);
    if (setup.collides()) setup.collider.submit_early({m2m_owner(), side, std::move(boxes)});
    if (from.has_kept_cover()) setup.ledger.local().add(Tally{.n_kept_sources = 1});
    return;
  }
  TargetSide& to = couplings.add_target(setup.id);
  to.setup = setup;
  if (setup.is_transposed()) {
    to.start_search(couplings.source(setup.forth).donor_rows(mesh));
  } else {
    std::vector<Aabb> boxes = to.start_search(mesh);
    if (setup.collides()) setup.collider.submit_early({m2m_owner(), side, std::move(boxes)});
  }
  if (!setup.has_directory()) return;
  std::vector<std::vector<PointReport>> by_pe(static_cast<std::size_t>(n_pes()));
  for (const PointReport& report : to.point_reports(mesh, m2m_owner()))
    by_pe[static_cast<std::size_t>(directory_pe(report.id, n_pes()))].push_back(report);
  for (std::int32_t pe = 0; pe < n_pes(); ++pe)
    if (auto& reports = by_pe[static_cast<std::size_t>(pe)]; !reports.empty())
      setup.directory[PeId{pe}].send<&PointDirectory::add>(std::move(reports));
}
void AnyPiece::m2m_hits(CouplingId id, const collide::Hits& hits) {
  couplings.target(id).add(hits);
}

void AnyPiece::m2m_ask(CouplingId id) {
  TargetSide& to = couplings.target(id);
  SearchStep step = to.next_step(m2m_view());
  for (auto& [source, query] : step.queries)
    m2m_send<&AnyPiece::m2m_query>(to.setup.source, source, std::move(query));
  for (auto& [source, choice] : step.choices)
    m2m_send<&AnyPiece::m2m_choose>(to.setup.source, source, std::move(choice));
  for (auto& [piece, answer] : step.beside)
    m2m_send<&AnyPiece::m2m_receive>(to.setup.target, piece, std::move(answer));
  Ledger& ledger = to.setup.ledger.local();
  if (step.then == SearchStep::Then::sources) ledger.add_waiting();
  if (step.then != SearchStep::Then::nothing) return;
  ledger.add(to.found().tally);
  ledger.add(to.found().worst);
  if (to.is_alone()) ledger.add_alone();
}
void AnyPiece::m2m_query(SearchQuery query) {
  const CouplingId id = query.coupling;
  const bool are_points = std::holds_alternative<DonorQuery>(query.what);
  SourceSide& from = couplings.source(id);
  const bool is_first = from.add(std::move(query));
  // Points are answered behind the queries that are in the queue of this PE.
  if (!are_points)
    m2m_answer(id);
  else if (is_first)
    from.setup.source.send<&AnyPiece::m2m_answer>(m2m_owner(), id);
}
void AnyPiece::m2m_answer(CouplingId id) {
  SourceSide& from = couplings.source(id);
  std::uint64_t n_tested = 0;
  for (auto& [target, answer] : from.answers(m2m_view(), n_tested))
    m2m_send<&AnyPiece::m2m_receive>(from.setup.target, target, std::move(answer));
  from.setup.ledger.local().add(Tally{.n_candidates = n_tested});
}
void AnyPiece::m2m_receive(SearchAnswer answer) {
  const CouplingId id = answer.coupling;
  if (couplings.target(id).add(std::move(answer))) m2m_ask(id);
}
void AnyPiece::m2m_name_points(CouplingId id) {
  const MeshView mesh = m2m_view();
  const CouplingSetup& setup = couplings.source(id).setup;
  const TargetFound& found = couplings.target(setup.forth).found();
  check_points(mesh, found);
  std::uint64_t n_lost = 0;
  for (auto& [piece, answer] : donated(id, mesh, found, m2m_owner(), n_lost))
    m2m_send<&AnyPiece::m2m_receive>(setup.target, piece, std::move(answer));
  setup.ledger.local().add(Tally{.n_lost = n_lost});
}
void AnyPiece::m2m_name(CouplingId id) {
  const MeshView mesh = m2m_view();
  const CouplingSetup& setup = couplings.source(id).setup;
  setup.ledger.local().add(SourcePiece{m2m_owner(), box_of_nearest(mesh, setup),
                                       static_cast<std::uint8_t>(mesh.points.empty() ? 0 : 1),
                                       static_cast<std::uint8_t>(mesh.tets.empty() ? 0 : 1)});
}
void AnyPiece::m2m_receive_names(CouplingId id, const std::vector<SourcePiece>& sources) {
  if (couplings.target(id).name_sources(m2m_view(), sources)) m2m_ask(id);
}
void AnyPiece::m2m_choose(Choice choice) {
  SourceSide& from = couplings.source(choice.coupling);
  std::uint64_t n_linear = 0;
  for (auto& [target, answer] : from.choose(m2m_view(), std::move(choice), n_linear))
    m2m_send<&AnyPiece::m2m_receive>(from.setup.target, target, std::move(answer));
  if (n_linear > 0) from.setup.ledger.local().add(Tally{.n_linear = n_linear});
}

void AnyPiece::m2m_give_values(CouplingId id, detail::Giver give, detail::Taker take) {
  SourceSide& from = couplings.source(id);
  from.give(m2m_view(), give->show(*this, id), take,
            [&](collide::OwnerId target, GivenValues given) {
              m2m_send<&AnyPiece::m2m_take>(from.setup.target, target, std::move(given));
            });
}
void AnyPiece::m2m_give_round(CouplingId id, detail::Giver give, detail::Taker take) {
  m2m_give_values(id, give, take);
  const SourceSide& from = couplings.source(id);
  for (const collide::OwnerId target : from.attached())
    from.setup.target.send<&AnyPiece::m2m_take_if_alone>(target, id, take);
}
void AnyPiece::m2m_take(GivenValues given) {
  const CouplingId id = given.coupling;
  const detail::Taker take = given.take;
  TargetSide& to = couplings.target(id);
  to.add(std::move(given));
  const auto send = [&](collide::OwnerId piece, GivenValues ghosts) {
    m2m_send<&AnyPiece::m2m_take>(to.setup.target, piece, std::move(ghosts));
  };
  while (to.advance(take, send)) {
    to.write(take->channel, take->show(*this, id));
    m2m_received(id);
  }
}
void AnyPiece::m2m_take_if_alone(CouplingId id, detail::Taker take) {
  const TargetSide& to = couplings.target(id);
  if (to.n_sources() != 0) return;
  fill_outside(to.setup.policy, to.found().status, take->show(*this, id));
  m2m_received(id);
}

void AnyPiece::m2m_give_rows(CouplingId id, GroupProxy<RowBook> book) {
  const MeshView mesh = m2m_view();
  SourceSide& from = couplings.source(id);
  for (auto& [target, rows] : from.donor_rows(mesh)) {
    GivenRows given{id, {}, book, {}};
    for (std::size_t i = 0; i < rows.n_rows(); ++i)
      given.rows.sizes.push_back(rows.columns_of(i).size());
    for (const VertexId column : rows.columns)
      given.rows.columns.push_back(mesh.point_ids[static_cast<std::size_t>(column)]);
    given.rows.weights = std::move(rows.weights);
    m2m_send<&AnyPiece::m2m_take_rows>(from.setup.target, target, std::move(given));
  }
}
void AnyPiece::m2m_take_rows(GivenRows given) {
  const MeshView mesh = m2m_view();
  const TargetFound& found = couplings.target(given.coupling).found();
  check_points(mesh, found);
  for (const std::uint32_t point : found.given.places_of(given.from))
    given.rows.targets.push_back(mesh.point_ids[point]);
  given.book.local().add(given.rows);
}

void AnyPiece::m2m_integrate(CouplingId id, GroupProxy<IntegralBook> book, detail::Giver give) {
  book.local().add(integrals_of(m2m_view(), give->show(*this, id)));
}
void AnyPiece::m2m_integrate_taken(CouplingId id, GroupProxy<IntegralBook> book,
                                   detail::Taker take) {
  book.local().add(integrals_of(m2m_view(), take->show(*this, id)));
}
void AnyPiece::m2m_scale(CouplingId id, detail::Taker take, const std::vector<double>& factors) {
  const std::span<double> values = take->show(*this, id);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] *= factors[i % factors.size()];
}

void AnyPiece::m2m_release(CouplingId id) {
  couplings.release(id);
}

}  // namespace tess::m2m
