#include "m2m/parallel/overlap_target.hpp"

#include "m2m/interpolate/locate.hpp"
#include "m2m/interpolate/orientation.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace tess::m2m {

namespace {

/// What is covered to a smaller fraction of its volume counts as not covered.
constexpr double no_coverage = 1e-12;

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

OverlapTarget::Addressed<OverlapQuery> OverlapTarget::queries(const MeshView& mesh) {
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
  for (const std::uint32_t row : answer.rows) asked.rows.push_back(asked.places[row]);
  asked.tets = {};
  asked.places = {};
}

OverlapTarget::Addressed<SharedRows> OverlapTarget::shared_rows() {
  std::vector<std::uint32_t> n_sources(volumes_.size(), 0);
  for (const auto& [piece, asked] : asked_)
    for (const std::uint32_t place : asked.rows) ++n_sources[place];
  Addressed<SharedRows> out;
  for (const auto& [piece, asked] : asked_) {
    if (asked.rows.empty()) continue;
    SharedRows message{setup.id, {}, {}};
    Source source{.piece = piece};
    for (const std::uint32_t place : asked.rows) {
      const bool is_shared = n_sources[place] > 1;
      message.shared.push_back(is_shared ? 1 : 0);
      if (!is_shared) source.places.push_back(place);
    }
    sources_.push_back(std::move(source));
    out.emplace_back(piece, std::move(message));
  }
  return out;
}

void OverlapTarget::join_partial_rows() {
  struct Entry {
    std::uint32_t place;
    GlobalId id;
    VertexId value;  // among those of all sources
    double weight;
  };
  std::sort(partial_.begin(), partial_.end(),
            [](const PartialRows& a, const PartialRows& b) { return a.from < b.from; });
  std::vector<std::uint32_t> n_sources(volumes_.size(), 0);
  for (const auto& [piece, asked] : asked_)
    for (const std::uint32_t place : asked.rows) ++n_sources[place];
  std::vector<Entry> entries;
  std::uint32_t n_values = 0;
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    const PartialRows& rows = partial_[s];
    sources_[s].first_value = n_values;
    sources_[s].n_values = static_cast<std::uint32_t>(rows.ids.size());
    std::size_t row = 0;
    for (const std::uint32_t place : asked_.at(rows.from).rows) {
      if (n_sources[place] < 2) continue;
      for (std::uint32_t k = rows.first[row]; k < rows.first[row + 1]; ++k)
        entries.push_back({place, rows.ids[rows.columns[k]],
                           static_cast<VertexId>(n_values + rows.columns[k]), rows.weights[k]});
      ++row;
    }
    n_values += sources_[s].n_values;
  }
  partial_ = {};
  asked_.clear();
  // By id, as in the rows of one piece; of several copies of an unknown, the first piece's is used.
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.place, a.id, a.value) < std::tie(b.place, b.id, b.value);
  });
  for (auto entry = entries.begin(); entry != entries.end();) {
    const std::uint32_t place = entry->place;
    while (entry != entries.end() && entry->place == place) {
      const Entry& first = *entry;
      double weight = 0;
      for (; entry != entries.end() && entry->place == place && entry->id == first.id; ++entry)
        weight += entry->weight;
      shared_rows_.add(first.value, weight);
    }
    shared_rows_.end_row();
    shared_places_.push_back(place);
  }
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
  join_partial_rows();
  for (const double fraction : covered_fractions(mesh)) {
    status_.push_back(!(fraction > no_coverage)     ? Status::outside
                      : fraction >= 1 - no_coverage ? Status::inside
                                                    : Status::snapped);
    ++tally_.counts[static_cast<std::size_t>(status_.back())];
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
  Channel& channel = channels_[loads.channel];
  const std::uint32_t round = loads.round;
  channel.loads.add(round, std::move(loads));
}
void OverlapTarget::add(GhostValues ghosts) {
  if (n_sources() == 0) return;
  Channel& channel = channels_[ghosts.channel];
  const std::uint32_t step = ghosts.step;
  channel.ghosts.add(step, std::move(ghosts));
}

std::size_t OverlapTarget::n_ghost_messages() const {
  std::size_t n = 0;
  for (const auto& [piece, neighbour] : neighbours_)
    if (neighbour.takes_part && !neighbour.ghosts.empty()) ++n;
  return n;
}

std::size_t OverlapTarget::components_of(const std::vector<GivenValues>& messages) const {
  const std::size_t per_load = setup.kind == TransferKind::conservative_bounded ? 3 : 1;
  std::size_t n_components = 0;
  for (const GivenValues& message : messages)
    for (const Source& source : sources_) {
      if (source.piece != message.from) continue;
      const std::size_t n =
          message.values.size() / (per_load * source.places.size() + source.n_values);
      TESS_CHECK(n_components == 0 || n == n_components, "source pieces give ", n_components,
                 " and ", n, " components in one round: give equally many");
      n_components = n;
    }
  return n_components;
}

OverlapTarget::Loads OverlapTarget::add_up(const std::vector<GivenValues>& messages) const {
  const std::size_t n = components_of(messages);
  const std::size_t n_places = status_.size();
  const bool bounded = setup.kind == TransferKind::conservative_bounded;
  constexpr double inf = std::numeric_limits<double>::infinity();
  Loads out;
  out.values.assign(n_places * n, 0);
  if (bounded) out.ranges.assign(n_places * n, {inf, -inf});
  const auto n_values = sources_.back().first_value + sources_.back().n_values;
  std::vector<double> values(n_values * n);
  for (const GivenValues& message : messages) {
    const auto source = std::find_if(sources_.begin(), sources_.end(),
                                     [&](const Source& s) { return s.piece == message.from; });
    const double* from = message.values.data();
    for (const std::uint32_t place : source->places)
      for (std::size_t c = 0; c < n; ++c) out.values[place * n + c] = *from++;
    if (bounded)
      for (const std::uint32_t place : source->places)
        for (std::size_t c = 0; c < n; ++c, from += 2)
          out.ranges[place * n + c] = {from[0], from[1]};
    std::copy_n(from, source->n_values * n, values.data() + source->first_value * n);
  }
  std::vector<double> sums(shared_places_.size() * n);
  m2m::apply(shared_rows_, values, n, sums);
  std::vector<ValueRange> ranges(bounded ? sums.size() : 0);
  if (bounded) value_ranges(shared_rows_, values, n, ranges);
  for (std::size_t k = 0; k < shared_places_.size(); ++k)
    for (std::size_t c = 0; c < n; ++c) {
      out.values[shared_places_[k] * n + c] = sums[k * n + c];
      if (bounded) out.ranges[shared_places_[k] * n + c] = ranges[k * n + c];
    }
  return out;
}

void OverlapTarget::start_round(Channel& channel) {
  Loads loads = add_up(channel.loads.take());
  const std::size_t n = status_.empty() ? 1 : loads.values.size() / status_.size();
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
  set_outside(to);
}

void OverlapTarget::set_outside(std::span<double> values) const {
  const auto* given = std::get_if<UseValue>(&setup.policy);
  if (given == nullptr || status_.empty()) return;
  const std::size_t n = values.size() / status_.size();
  for (std::size_t v = 0; v < status_.size(); ++v)
    if (status_[v] == Status::outside) std::fill_n(values.data() + v * n, n, given->value);
}

}  // namespace tess::m2m
