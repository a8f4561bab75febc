#include "m2m/parallel/worker.hpp"

#include <algorithm>
#include <utility>

namespace tess::m2m {

Outcome JoinOutcomes::operator()(Outcome a, const Outcome& b) const {
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  a.status.insert(a.status.end(), b.status.begin(), b.status.end());
  a.values.insert(a.values.end(), b.values.begin(), b.values.end());
  a.distance.insert(a.distance.end(), b.distance.begin(), b.distance.end());
  return a;
}

void Worker::load(PartLoad load) {
  part_ = std::move(load.part);
  n_components_ = load.n_components;
  values_ = std::move(load.values);
  status_.assign(static_cast<std::size_t>(part_.n_owned), Status::outside);
  distance_.assign(status_.size(), 0);
}

void Worker::move(const RigidMotion& motion) {
  move_points(part_.points, motion);
}

MeshView Worker::mesh_view() const {
  return {part_.points,  part_.tets,    part_.point_ids,
          part_.tet_ids, part_.n_owned, part_.n_own_tets};
}

Worker::Pending& Worker::pending_of(CouplingId coupling) {
  Pending& pending = pending_[coupling];
  if (pending.is_new.empty()) {
    pending.values.resize(values_.size());
    pending.is_new.resize(part_.points.size());
  }
  return pending;
}

std::span<double> Worker::pending(CouplingId coupling) {
  return std::span(pending_of(coupling).values)
      .first(static_cast<std::size_t>(part_.n_owned) * n_components_);
}

void Worker::received(CouplingId coupling) {
  Pending& pending = pending_of(coupling);
  const bool keeps = std::holds_alternative<Keep>(policy(coupling));
  const std::span<const Status> status = this->status(coupling);
  for (std::size_t v = 0; v < status.size(); ++v)
    pending.is_new[v] = status[v] != Status::outside || !keeps ? 1 : 0;
  for (const Ghosts& ghosts : part_.ghosts) {
    GhostRows message{coupling, {}, {}};
    for (std::size_t i = 0; i < ghosts.here.size(); ++i) {
      const auto v = static_cast<std::size_t>(ghosts.here[i]);
      if (pending.is_new[v] == 0) continue;
      message.rows.push_back(ghosts.there[i]);
      const double* row = pending.values.data() + v * n_components_;
      message.values.insert(message.values.end(), row, row + n_components_);
    }
    if (!message.rows.empty())
      array()[{ghosts.part}].send<&Worker::receive_ghosts>(std::move(message));
  }
}

void Worker::receive_ghosts(const GhostRows& ghosts) {
  Pending& pending = pending_of(ghosts.coupling);
  for (std::size_t i = 0; i < ghosts.rows.size(); ++i) {
    const auto v = static_cast<std::size_t>(ghosts.rows[i]);
    std::copy_n(ghosts.values.data() + i * n_components_, n_components_,
                pending.values.data() + v * n_components_);
    pending.is_new[v] = 1;
  }
}

void Worker::commit(CouplingId coupling) {
  Pending pending = std::exchange(pending_[coupling], {});
  pending_.erase(coupling);
  for (std::size_t v = 0; v < pending.is_new.size(); ++v)
    if (pending.is_new[v] != 0)
      std::copy_n(pending.values.data() + v * n_components_, n_components_,
                  values_.data() + v * n_components_);
  const std::span<const Status> status = this->status(coupling);
  status_.assign(status.begin(), status.end());
  const std::span<const double> distance = this->distance(coupling);
  std::copy(distance.begin(), distance.end(), distance_.begin());
}

void Worker::gather(Callback<Outcome> target) {
  const auto owned = static_cast<std::ptrdiff_t>(part_.n_owned);
  const auto n = static_cast<std::ptrdiff_t>(n_components_);
  Outcome outcome{{part_.point_ids.begin(), part_.point_ids.begin() + owned},
                  status_,
                  {values_.begin(), values_.begin() + owned * n},
                  distance_};
  contribute(JoinOutcomes{}, std::move(outcome), std::move(target));
}

}  // namespace tess::m2m
