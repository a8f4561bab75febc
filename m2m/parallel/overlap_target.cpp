#include "m2m/parallel/overlap_target.hpp"

#include "m2m/interpolate/orientation.hpp"
#include "m2m/tets_of_vertices.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tess::m2m {

std::vector<Aabb> OverlapTarget::start_search(const MeshView& mesh) {
  validate(mesh);
  asked_.clear();
  neighbours_.clear();
  channels_.clear();
  covered_ = {};
  tally_ = {};
  if (to_cells()) {
    numbers_.resize(mesh.own_tets().size());
    std::iota(numbers_.begin(), numbers_.end(), 0);
  } else {
    numbers_ = tets_at_owned(mesh);
  }
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
    reports[v] = {mesh.point_ids[v], me, static_cast<std::int32_t>(v), 0, is_owned ? 0 : -1};
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

OverlapTarget::Addressed<OverlapQuery> OverlapTarget::queries(const MeshView& mesh) {
  Addressed<OverlapQuery> out;
  for (auto& [source, asked] : asked_) {
    sort_unique(asked.boxes);
    OverlapQuery query{setup.id, {}, {}};
    TargetTets& to = query.tets;
    for (auto pair = asked.boxes.begin(); pair != asked.boxes.end();) {
      const std::uint32_t box = pair->first;
      for (const std::uint32_t member : cover_.members_of(box)) {
        const auto tet = static_cast<std::size_t>(numbers_[member]);
        asked.tets.push_back(member);
        to.tets.push_back(corners_of(mesh.points, mesh.tets[tet]));
      }
      to.first.push_back(static_cast<std::uint32_t>(to.tets.size()));
      for (; pair != asked.boxes.end() && pair->first == box; ++pair)
        to.near.push_back(pair->second);
      to.first_near.push_back(static_cast<std::uint32_t>(to.near.size()));
    }
    asked.boxes = {};
    out.emplace_back(source, std::move(query));
  }
  cover_ = {};
  return out;
}

void OverlapTarget::add(OverlapAnswer answer) {
  tally_.n_candidates += answer.n_tested;
  Asked& asked = asked_.at(answer.from);
  asked.answer = std::move(answer);
}

void OverlapTarget::add(const SharedPoints& shared) {
  for (const SharedPoint& point : shared.points) {
    Neighbour& neighbour = neighbours_[point.other];
    (point.is_owner ? neighbour.owned : neighbour.ghosts).emplace_back(point.id, point.point);
  }
}

OverlapTarget::Addressed<SharedTets> OverlapTarget::shared() {
  sources_.clear();
  std::erase_if(asked_, [](const auto& entry) { return entry.second.answer.tets.empty(); });
  std::vector<std::uint32_t> n_sources(numbers_.size(), 0);
  for (const auto& [source, asked] : asked_)
    for (const std::uint32_t tet : asked.answer.tets) ++n_sources[asked.tets[tet]];

  struct Placed {
    std::uint32_t number;
    GlobalId source_id;
    Block block;
  };
  std::vector<Placed> placed;
  Addressed<SharedTets> out;
  for (const auto& [source, asked] : asked_) {
    const OverlapAnswer& answer = asked.answer;
    SharedTets message{setup.id, {}, {}};
    std::uint32_t position = 0;
    const auto slot = static_cast<std::uint32_t>(sources_.size());
    for (std::size_t k = 0; k < answer.tets.size(); ++k) {
      const std::uint32_t number = asked.tets[answer.tets[k]];
      const bool is_shared = n_sources[number] > 1;
      message.shared.push_back(is_shared ? 1 : 0);
      const std::uint32_t end = is_shared ? answer.first[k + 1] : answer.first[k] + 1;
      for (std::uint32_t i = answer.first[k]; i < end; ++i)
        placed.push_back({number, answer.ids[i], {slot, position++}});
    }
    sources_.push_back(source);
    out.emplace_back(source, std::move(message));
  }
  asked_.clear();
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.number != b.number ? a.number < b.number : a.source_id < b.source_id;
  });
  first_block_.assign(numbers_.size() + 1, 0);
  blocks_.clear();
  for (const Placed& p : placed) {
    ++first_block_[p.number + 1];
    blocks_.push_back(p.block);
  }
  for (std::size_t k = 0; k < numbers_.size(); ++k) first_block_[k + 1] += first_block_[k];
  return out;
}

OverlapTarget::Summed OverlapTarget::sum_up(const std::vector<GivenValues>& messages,
                                            bool with_ranges) const {
  Summed out;
  std::vector<const double*> by_source(sources_.size(), nullptr);
  std::vector<std::uint32_t> n_blocks(sources_.size(), 0);
  for (const Block& block : blocks_) ++n_blocks[block.source];
  const std::size_t corners = to_cells() ? 1 : 4;
  const bool ranges = with_ranges && setup.kind == TransferKind::conservative_bounded;
  std::size_t n_components = 0;
  for (const GivenValues& message : messages) {
    const auto at = std::lower_bound(sources_.begin(), sources_.end(), message.from);
    const auto slot = static_cast<std::size_t>(at - sources_.begin());
    by_source[slot] = message.values.data();
    const std::size_t per_block = message.values.size() / n_blocks[slot];
    const std::size_t n = per_block / (corners + (ranges ? 2 : 0));
    TESS_CHECK(n_components == 0 || n == n_components, "source pieces give ", n_components, " and ",
               n, " components in one round: give equally many");
    n_components = n;
  }
  const std::size_t n_loads = corners * n_components;
  const std::size_t stride = n_loads + (ranges ? 2 * n_components : 0);
  out.loads.assign(numbers_.size() * n_loads, 0);
  constexpr double inf = std::numeric_limits<double>::infinity();
  if (ranges) out.ranges.assign(numbers_.size() * n_components, {inf, -inf});
  for (std::size_t k = 0; k < numbers_.size(); ++k)
    for (std::uint32_t b = first_block_[k]; b < first_block_[k + 1]; ++b) {
      const double* from = by_source[blocks_[b].source] + blocks_[b].position * stride;
      for (std::size_t i = 0; i < n_loads; ++i) out.loads[k * n_loads + i] += *from++;
      if (!ranges) continue;
      for (std::size_t c = 0; c < n_components; ++c, from += 2) {
        ValueRange& range = out.ranges[k * n_components + c];
        range = {std::min(range.low, from[0]), std::max(range.high, from[1])};
      }
    }
  return out;
}

std::vector<collide::OwnerId> OverlapTarget::finish_search(const MeshView& mesh) {
  std::vector<double> covered(numbers_.size() * (to_cells() ? 1 : 4), 0);
  if (n_sources() > 0) covered = sum_up(covered_.take(), false).loads;
  std::vector<double> fractions;
  if (to_cells()) {
    for (std::size_t t = 0; t < numbers_.size(); ++t) {
      const auto c = corners_of(mesh.points, mesh.tets[t]);
      const double volume = std::abs(orientation(c[0], c[1], c[2], c[3])) / 6;
      fractions.push_back(volume > 0 ? covered[t] / volume : 0);
    }
    volumes_ = std::move(covered);
  } else {
    mass_ = MassMatrix(mesh, numbers_, covered);
    fractions.assign(mass_.covered_fractions().begin(), mass_.covered_fractions().end());
  }
  status_.clear();
  for (const double fraction : fractions) {
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

void OverlapTarget::start_round(Channel& channel) {
  Summed sums = sum_up(channel.loads.take(), true);
  if (to_cells()) {
    const std::size_t n = volumes_.empty() ? 1 : sums.loads.size() / volumes_.size();
    for (std::size_t t = 0; t < volumes_.size(); ++t)
      for (std::size_t c = 0; c < n; ++c)
        sums.loads[t * n + c] =
            status_[t] == Status::outside ? 0 : sums.loads[t * n + c] / volumes_[t];
    channel.result = std::move(sums.loads);
    return;
  }
  using Form = Projection::Form;
  const Form form = setup.kind == TransferKind::conservative          ? Form::consistent
                    : setup.kind == TransferKind::conservative_lumped ? Form::lumped
                                                                      : Form::bounded;
  const std::size_t n = sums.loads.size() / (4 * numbers_.size());
  channel.projection.emplace(mass_, n, form, sums.loads, sums.ranges);
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
