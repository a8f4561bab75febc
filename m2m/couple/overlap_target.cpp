#include "m2m/couple/overlap_target.hpp"

#include "m2m/rows/interpolate/locate.hpp"
#include "m2m/rows/interpolate/orientation.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tess::m2m {

namespace {

/// What is covered to a smaller fraction of its volume counts as not covered.
constexpr double no_coverage = 1e-12;
/// What is covered to a larger fraction is covered more than once; less is rounding.
constexpr double over_coverage = 1 + 1e-9;

double volume_of(const MeshView& mesh, const Tet& tet) {
  const auto c = corners_of(mesh.points, tet);
  return std::abs(orientation(c[0], c[1], c[2], c[3])) / 6;
}

}  // namespace

std::vector<Aabb> OverlapTarget::start_search(const MeshView& mesh) {
  validate(mesh);
  const CouplingSetup kept = setup;
  *this = {};
  setup = kept;
  if (to_cells()) {
    numbers_.resize(mesh.own_tets().size());
    std::iota(numbers_.begin(), numbers_.end(), 0);
    for (const Tet& tet : mesh.own_tets()) volumes_.push_back(volume_of(mesh, tet));
  } else {
    numbers_ = tets_at_owned(mesh);
    volumes_.assign(mesh.points.size(), 0);
    for (const std::int32_t number : numbers_) {
      const Tet& tet = mesh.tets[static_cast<std::size_t>(number)];
      for (const VertexId v : tet) volumes_[static_cast<std::size_t>(v)] += volume_of(mesh, tet);
    }
  }
  covered_.assign(numbers_.size(), {});
  std::vector<Tet> tets;
  for (const std::int32_t t : numbers_) tets.push_back(mesh.tets[static_cast<std::size_t>(t)]);
  cover_ = cover_tets(mesh.points, tets);
  return std::exchange(cover_.boxes, {});
}

std::vector<PointReport> OverlapTarget::point_reports(const MeshView& mesh,
                                                      collide::OwnerId me) const {
  std::vector<PointReport> reports(mesh.points.size());
  for (std::size_t v = 0; v < reports.size(); ++v) {
    const bool is_owned = static_cast<std::int64_t>(v) < mesh.n_owned;
    reports[v] = {mesh.point_ids[v], me,         static_cast<std::int32_t>(v), 0,
                  is_owned ? 0 : -1, volumes_[v]};
  }
  const std::size_t n_own = mesh.own_tets().size();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const VertexId corner : mesh.tets[t]) {
      PointReport& report = reports[static_cast<std::size_t>(corner)];
      if (report.n_tets >= 0) ++report.n_tets;
      if (t < n_own) ++report.n_own_tets;
    }
  return reports;
}

void OverlapTarget::add(const collide::Hits& hits) {
  Asked& asked = asked_[hits.other];
  for (const collide::LocalPair& pair : hits.pairs)
    asked.boxes.emplace_back(static_cast<std::uint32_t>(pair.mine),
                             static_cast<std::uint32_t>(pair.theirs));
}

void OverlapTarget::add(const SharedPoints& shared) {
  for (const SharedPoint& point : shared.points) {
    Neighbour& neighbour = neighbours_[point.other];
    (point.is_owner ? neighbour.owned : neighbour.ghosts).emplace_back(point.id, point.point);
    if (!point.is_owner) volumes_[static_cast<std::size_t>(point.point)] = point.volume;
  }
}

std::array<std::uint32_t, 4> OverlapTarget::places_of(const MeshView& mesh,
                                                      std::uint32_t tet) const {
  std::array<std::uint32_t, 4> places;
  if (to_cells()) {
    places.fill(tet);
  } else {
    const Tet& corners = mesh.tets[static_cast<std::size_t>(numbers_[tet])];
    for (std::size_t c = 0; c < 4; ++c) places[c] = static_cast<std::uint32_t>(corners[c]);
  }
  return places;
}

Addressed<OverlapQuery> OverlapTarget::queries(const MeshView& mesh) {
  const std::size_t n_places =
      to_cells() ? numbers_.size() : static_cast<std::size_t>(mesh.n_owned);
  Addressed<OverlapQuery> out;
  std::vector<std::int32_t> unknown_of(volumes_.size(), -1);
  for (auto& [source, asked] : asked_) {
    sort_unique(asked.boxes);
    OverlapQuery query{setup.id, {}, {}};
    TargetTets& to = query.tets;
    for (auto pair = asked.boxes.begin(); pair != asked.boxes.end();) {
      const std::uint32_t box = pair->first;
      for (const std::uint32_t member : cover_.members_of(box)) {
        asked.tets.push_back(member);
        to.tets.push_back(
            corners_of(mesh.points, mesh.tets[static_cast<std::size_t>(numbers_[member])]));
      }
      to.first.push_back(static_cast<std::uint32_t>(to.tets.size()));
      for (; pair != asked.boxes.end() && pair->first == box; ++pair)
        to.near.push_back(pair->second);
      to.first_near.push_back(static_cast<std::uint32_t>(to.near.size()));
    }
    asked.boxes = {};
    // Places first, then ghosts.
    std::vector<std::uint32_t> numbered;
    for (const bool ghosts : {false, true}) {
      for (const std::uint32_t tet : asked.tets)
        for (const std::uint32_t place : places_of(mesh, tet)) {
          if ((place >= n_places) != ghosts || unknown_of[place] >= 0) continue;
          unknown_of[place] = static_cast<std::int32_t>(numbered.size());
          numbered.push_back(place);
        }
      if (!ghosts) asked.places = numbered;
    }
    to.n_rows = static_cast<std::uint32_t>(asked.places.size());
    for (const std::uint32_t place : numbered) to.quanta.push_back(quantum_of(volumes_[place]));
    for (const std::uint32_t tet : asked.tets) {
      std::array<std::uint32_t, 4> unknowns = places_of(mesh, tet);
      for (std::uint32_t& u : unknowns) u = static_cast<std::uint32_t>(unknown_of[u]);
      to.unknowns.push_back(unknowns);
    }
    for (const std::uint32_t place : numbered) unknown_of[place] = -1;
    out.emplace_back(source, std::move(query));
  }
  cover_ = {};
  return out;
}

void OverlapTarget::add(const OverlapAnswer& answer) {
  tally_.n_candidates += answer.n_tested;
  Asked& asked = asked_.at(answer.from);
  for (std::size_t k = 0; k < answer.tets.size(); ++k)
    for (std::size_t a = 0; a < 4; ++a)
      covered_[asked.tets[answer.tets[k]]][a] += answer.covered[k][a];  // exact in any order
  std::vector<std::uint32_t> places;
  for (const std::uint32_t row : answer.rows) places.push_back(asked.places[row]);
  loads_.add_source(answer.from, std::move(places));
  asked_.erase(answer.from);
}

Addressed<SharedRows> OverlapTarget::shared_rows() {
  Addressed<SharedRows> out;
  for (auto& [piece, flags] : loads_.shared())
    out.emplace_back(piece, SharedRows{setup.id, {}, std::move(flags)});
  return out;
}

std::vector<double> OverlapTarget::covered_fractions(const MeshView& mesh) {
  if (!to_cells()) {
    mass_ = MassMatrix(mesh, numbers_, covered_);
    covered_ = {};
    return {mass_.covered_fractions().begin(), mass_.covered_fractions().end()};
  }
  std::vector<double> fractions;
  for (std::size_t t = 0; t < numbers_.size(); ++t) {
    const std::array<double, 4>& c = covered_[t];
    fractions.push_back(volumes_[t] > 0 ? ((c[0] + c[1]) + (c[2] + c[3])) / volumes_[t] : 0);
  }
  return fractions;
}

std::vector<collide::OwnerId> OverlapTarget::finish_search(const MeshView& mesh) {
  loads_.join();
  for (const double fraction : covered_fractions(mesh)) {
    status_.push_back(!(fraction > no_coverage)     ? Status::outside
                      : fraction >= 1 - no_coverage ? Status::inside
                                                    : Status::snapped);
    ++tally_.counts[static_cast<std::size_t>(status_.back())];
    if (fraction > over_coverage) {
      ++tally_.n_overcovered;
      tally_.most_covered = std::max(tally_.most_covered, fraction);
    }
  }
  std::vector<collide::OwnerId> out;
  for (auto& [piece, neighbour] : neighbours_) {
    std::sort(neighbour.owned.begin(), neighbour.owned.end());
    std::sort(neighbour.ghosts.begin(), neighbour.ghosts.end());
    if (n_sources() > 0) out.push_back(piece);
  }
  return out;
}

void OverlapTarget::add(GivenValues loads) {
  Channel& channel = channels_[loads.take->channel];
  const std::uint32_t round = loads.round;
  channel.loads.add(round, std::move(loads));
}
void OverlapTarget::add(GhostValues ghosts) {
  if (n_sources() == 0) return;
  Channel& channel = channels_[ghosts.take->channel];
  const std::uint32_t step = ghosts.step;
  channel.ghosts.add(step, std::move(ghosts));
}

std::size_t OverlapTarget::n_ghost_messages() const {
  std::size_t n = 0;
  for (const auto& [piece, neighbour] : neighbours_)
    if (neighbour.takes_part && !neighbour.ghosts.empty()) ++n;
  return n;
}

void OverlapTarget::start_round(Channel& channel) {
  OverlapLoads::Sums loads = loads_.add_up(channel.loads.take(), status_.size(),
                                           setup.kind == TransferKind::conservative_bounded);
  const std::size_t n = loads.n_components;
  for (const double load : loads.values)
    if (std::isinf(load))
      fail(ErrorCode::bad_value, "an integral of a ", name_of(setup.kind),
           " transfer is infinite: a value is, or a value times a volume is above 1e308; scale the "
           "field or the meshes");
  if (to_cells()) {
    for (std::size_t t = 0; t < covered_.size(); ++t) {
      const std::array<double, 4>& covered = covered_[t];
      const double volume = (covered[0] + covered[1]) + (covered[2] + covered[3]);
      for (std::size_t c = 0; c < n; ++c)
        if (volume > 0) loads.values[t * n + c] /= volume;
    }
    channel.result = std::move(loads.values);
    return;
  }
  using Form = Projection::Form;
  const Form form = setup.kind == TransferKind::conservative          ? Form::consistent
                    : setup.kind == TransferKind::conservative_lumped ? Form::lumped
                                                                      : Form::bounded;
  channel.projection.emplace(mass_, n, form, std::move(loads.values), std::move(loads.ranges));
}

void OverlapTarget::take_ghosts(Channel& channel) {
  const std::size_t n = channel.projection->n_columns();
  const std::span<double> shared = channel.projection->shared();
  for (const GhostValues& message : channel.ghosts.take()) {
    const double* from = message.values.data();
    for (const auto& [id, point] : neighbours_.at(message.from).ghosts) {
      std::copy_n(from, n, shared.data() + static_cast<std::size_t>(point) * n);
      from += n;
    }
  }
  channel.waits = false;
}

void OverlapTarget::write(std::uint64_t channel_id, std::span<double> to) const {
  const std::vector<double>& result = channels_.at(channel_id).result;
  TESS_CHECK(to.size() == result.size(), "the source gives ", result.size(),
             " values for the piece's ", status_.size(), " places, but the target takes ",
             to.size(), ": take places × components");
  if (status_.empty()) return;
  const std::size_t n = result.size() / status_.size();
  for (std::size_t v = 0; v < status_.size(); ++v)
    if (status_[v] != Status::outside) std::copy_n(result.data() + v * n, n, to.data() + v * n);
  fill_outside(setup.policy, status_, to);
}

}  // namespace tess::m2m
