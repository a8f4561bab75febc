#include "m2m/couple/target_side.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {

void TargetSide::forget() {
  n_open_ = 0;
  found_ = {};
  least_source_.reset();
  neighbours_.clear();
  channels_.clear();
}

std::vector<Aabb> TargetSide::start_search(const MeshView& mesh) {
  forget();
  if (!setup.is_conservative()) return search_.emplace<PointSearch>().start(setup, mesh);
  return search_.emplace<OverlapSearch>(setup.target_values).start(mesh);
}

void TargetSide::start_search(Addressed<Rows<double>> rows) {
  forget();
  search_.emplace<TransposedSearch>(std::move(rows));
}

std::vector<PointReport> TargetSide::point_reports(const MeshView& mesh,
                                                   collide::OwnerId me) const {
  if (const auto* transposed = std::get_if<TransposedSearch>(&search_))
    return transposed->point_reports(mesh, me);
  return std::get<OverlapSearch>(search_).point_reports(mesh, me);
}

void TargetSide::add(const collide::Hits& hits) {
  if (auto* points = std::get_if<PointSearch>(&search_))
    points->add(hits);
  else
    std::get<OverlapSearch>(search_).add(hits);
}

bool TargetSide::add(SearchAnswer answer) {
  if (auto* transposed = std::get_if<TransposedSearch>(&search_)) {
    transposed->add(std::move(answer));
    return false;  // the handle says when all have come
  }
  if (const auto* shared = std::get_if<SharedPoints>(&answer.what)) {
    for (const SharedPoint& point : shared->points) {
      Neighbour& neighbour = neighbours_[point.other];
      (point.is_owner ? neighbour.owned : neighbour.ghosts).emplace_back(point.id, point.point);
      if (!point.is_owner) std::get<OverlapSearch>(search_).set_volume(point.point, point.volume);
    }
    return false;
  }
  if (std::holds_alternative<Greeting>(answer.what)) {
    neighbours_.at(answer.from).takes_part = true;
    return false;
  }
  if (const auto* points = std::get_if<DonorAnswer>(&answer.what))
    std::get<PointSearch>(search_).add(setup, answer.from, *points);
  else if (const auto* nearest = std::get_if<NearestAnswer>(&answer.what))
    std::get<PointSearch>(search_).add(answer.from, *nearest);
  else if (const auto* overlaps = std::get_if<OverlapAnswer>(&answer.what))
    std::get<OverlapSearch>(search_).add(answer.from, *overlaps, found_);
  else
    std::get<OverlapSearch>(search_).add(answer.from,
                                         std::get<PartialRows>(std::move(answer.what)));
  return --n_open_ == 0;
}

bool TargetSide::name_sources(const MeshView& mesh, std::span<const SourcePiece> sources) {
  if (!sources.empty()) least_source_ = sources.front().owner;
  auto* const points = std::get_if<PointSearch>(&search_);
  if (points != nullptr) points->name_sources(mesh, sources);
  return points != nullptr || n_sources() == 0;
}

SearchStep TargetSide::next_step(const MeshView& mesh) {
  SearchStep step;
  if (auto* points = std::get_if<PointSearch>(&search_)) step = points->next(setup, mesh, found_);
  if (auto* overlaps = std::get_if<OverlapSearch>(&search_))
    step = overlaps->next(setup, mesh, found_);
  if (auto* transposed = std::get_if<TransposedSearch>(&search_))
    step = transposed->next(setup, mesh, found_);
  if (step.then == SearchStep::Then::answers) n_open_ = step.queries.size() + step.choices.size();
  if (step.then == SearchStep::Then::nothing) {
    search_ = {};
    for (auto& [piece, neighbour] : neighbours_) {
      std::sort(neighbour.owned.begin(), neighbour.owned.end());
      std::sort(neighbour.ghosts.begin(), neighbour.ghosts.end());
      if (n_sources() > 0) step.beside.emplace_back(piece, SearchAnswer{setup.id, {}, Greeting{}});
    }
  }
  if (std::holds_alternative<std::monostate>(search_) && n_sources() == 0 && least_source_)
    step.choices.emplace_back(*least_source_, Choice{setup.id, {}, {}, {}, true});
  return step;
}

void TargetSide::add(GivenValues given) {
  // The piece takes no part in a projection without loads.
  if (given.are_ghosts && n_sources() == 0) return;
  Channel& channel = channels_[given.take->channel];
  (given.are_ghosts ? channel.ghosts : channel.given).add(std::move(given));
}

bool TargetSide::advance(detail::Taker take,
                         const std::function<void(collide::OwnerId, GivenValues)>& send) {
  Channel& channel = channels_[take->channel];
  if (channel.waits) {
    if (!channel.ghosts.has_next(n_ghost_messages())) return false;
    take_ghosts(channel);
  } else {
    if (!channel.given.has_next(n_sources())) return false;
    if (!setup.applies_at_target()) return true;
    start_round(channel);
    if (!setup.has_projection()) return true;
  }
  while (channel.projection->step(found_.mass)) {
    send_owned(channel, take, send);
    const std::size_t n = n_ghost_messages();
    channel.waits = n > 0;
    if (!channel.waits) continue;
    if (!channel.ghosts.has_next(n)) return false;
    take_ghosts(channel);
  }
  channel.result.assign(channel.projection->values().begin(), channel.projection->values().end());
  channel.projection.reset();
  return true;
}

std::size_t TargetSide::n_ghost_messages() const {
  std::size_t n = 0;
  for (const auto& [piece, neighbour] : neighbours_)
    if (neighbour.takes_part && !neighbour.ghosts.empty()) ++n;
  return n;
}

void TargetSide::start_round(Channel& channel) {
  const bool keeps_range = setup.fits() && setup.clamp;
  GivenPlaces::Sums loads =
      found_.given.add_up(channel.given.take(), found_.status.size(),
                          keeps_range || setup.kind == TransferKind::conservative_bounded);
  for (std::size_t i = 0; keeps_range && i < loads.values.size(); ++i)
    if (const ValueRange& range = loads.ranges[i]; range.low <= range.high)
      loads.values[i] = std::clamp(loads.values[i], range.low, range.high);
  const std::size_t n = loads.n_components;
  for (const double load : loads.values)
    if (setup.is_conservative() && std::isinf(load))
      fail(ErrorCode::bad_value, "an integral of a ", name_of(setup.kind),
           " transfer is infinite: a value is, or a value times a volume is above 1e308; scale the "
           "field or the meshes");
  if (!setup.has_projection()) {
    for (std::size_t t = 0; t < found_.covered_volumes.size(); ++t)
      for (std::size_t c = 0; c < n; ++c)
        if (found_.covered_volumes[t] > 0) loads.values[t * n + c] /= found_.covered_volumes[t];
    channel.result = std::move(loads.values);
    return;
  }
  using Form = Projection::Form;
  const Form form = setup.kind == TransferKind::conservative          ? Form::consistent
                    : setup.kind == TransferKind::conservative_lumped ? Form::lumped
                                                                      : Form::bounded;
  channel.projection.emplace(found_.mass, n, form, std::move(loads.values),
                             std::move(loads.ranges));
}

void TargetSide::send_owned(Channel& channel, detail::Taker take,
                            const std::function<void(collide::OwnerId, GivenValues)>& send) {
  const std::size_t n = channel.projection->n_columns();
  const std::span<const double> shared = channel.projection->shared();
  for (const auto& [piece, neighbour] : neighbours_) {
    if (!neighbour.takes_part || neighbour.owned.empty()) continue;
    GivenValues message{setup.id, {}, take, channel.n_steps, {}, true};
    for (const auto& [id, point] : neighbour.owned) {
      const auto row = shared.subspan(static_cast<std::size_t>(point) * n, n);
      message.values.insert(message.values.end(), row.begin(), row.end());
    }
    send(piece, std::move(message));
  }
  ++channel.n_steps;
}

void TargetSide::take_ghosts(Channel& channel) {
  const std::size_t n = channel.projection->n_columns();
  const std::span<double> shared = channel.projection->shared();
  for (const GivenValues& message : channel.ghosts.take()) {
    const double* from = message.values.data();
    for (const auto& [id, point] : neighbours_.at(message.from).ghosts) {
      std::copy_n(from, n, shared.data() + static_cast<std::size_t>(point) * n);
      from += n;
    }
  }
  channel.waits = false;
}

void TargetSide::write(std::uint64_t channel_id, std::span<double> values) {
  Channel& channel = channels_.at(channel_id);
  if (setup.applies_at_target())
    write_result(channel.result, values);
  else
    write_given(channel.given.take(), values);
  fill_outside(setup.policy, found_.status, values);
}

void TargetSide::write_given(const std::vector<GivenValues>& messages, std::span<double> to) const {
  for (const GivenValues& message : messages) {
    const std::span<const std::uint32_t> places = found_.given.places_of(message.from);
    const std::size_t n = message.values.size() / places.size();
    TESS_CHECK(to.size() == n * found_.status.size(), "the source gives ", n,
               " components per point, but the target takes ", to.size(), " values for its ",
               found_.status.size(), " points: take points × components");
    for (std::size_t i = 0; i < places.size(); ++i)
      std::copy_n(message.values.data() + i * n, n, to.data() + places[i] * n);
  }
}

void TargetSide::write_result(const std::vector<double>& result, std::span<double> to) const {
  TESS_CHECK(to.size() == result.size(), "the source gives ", result.size(),
             " values for the piece's ", found_.status.size(), " places, but the target takes ",
             to.size(), ": take places × components");
  if (result.empty()) return;
  const std::size_t n = result.size() / found_.status.size();
  for (std::size_t v = 0; v < found_.status.size(); ++v)
    if (found_.status[v] != Status::outside)
      std::copy_n(result.data() + v * n, n, to.data() + v * n);
}

}  // namespace tess::m2m
