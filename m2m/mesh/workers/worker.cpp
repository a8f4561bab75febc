#include "m2m/mesh/workers/worker.hpp"

#include "m2m/io/vtu/vtu_writer.hpp"

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
  centring_ = load.centring;
  values_ = std::move(load.values);
  if (centring_ == Centring::corners)
    values_ = element_corners(view_of(part_), load.elements, values_, n_components_, load.limit);
  status_.assign(own_ids().size(), Status::outside);
  distance_.assign(status_.size(), 0);
}

void Worker::move(const RigidMotion& motion) {
  move_points(part_.points, motion);
}

MeshView Worker::mesh_view() const {
  return view_of(part_);
}

Worker::Pending& Worker::pending_of(CouplingId coupling) {
  Pending& pending = pending_[coupling];
  if (pending.is_new.empty()) {
    pending.values.resize(values_.size());
    pending.is_new.resize(has_nodes() ? part_.points.size() : part_.tets.size());
  }
  return pending;
}

std::span<double> Worker::pending(CouplingId coupling) {
  return std::span(pending_of(coupling).values).first(own_ids().size() * n_components_);
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
  const std::span<const double> distance = this->distance(coupling);  // empty: conservative kinds
  if (distance.empty())
    std::ranges::fill(distance_, 0.0);
  else
    std::ranges::copy(distance, distance_.begin());
}

void Worker::gather(Callback<Outcome> target) {
  const std::span<const GlobalId> ids = own_ids();
  const auto values = std::span(values_).first(ids.size() * n_components_);
  Outcome outcome{{ids.begin(), ids.end()}, status_, {values.begin(), values.end()}, distance_};
  contribute(JoinOutcomes{}, std::move(outcome), std::move(target));
}

void Worker::share_status() {
  ghost_status_.resize(part_.points.size() - status_.size(), Status::outside);
  for (const Ghosts& ghosts : part_.ghosts) {
    GhostStatus message{ghosts.there, {}};
    for (const std::int32_t v : ghosts.here)
      message.status.push_back(status_[static_cast<std::size_t>(v)]);
    array()[{ghosts.part}].send<&Worker::receive_status>(std::move(message));
  }
}

void Worker::receive_status(const GhostStatus& ghosts) {
  ghost_status_.resize(part_.points.size() - status_.size(), Status::outside);
  for (std::size_t i = 0; i < ghosts.rows.size(); ++i)
    ghost_status_[static_cast<std::size_t>(ghosts.rows[i]) - status_.size()] = ghosts.status[i];
}

void Worker::measure(const NormsRequest& request, Callback<NormSums> target) {
  std::vector<Status> status = status_;
  status.insert(status.end(), ghost_status_.begin(), ghost_status_.end());
  contribute(JoinNorms{}, norm_sums(mesh_view(), values_, status, request), std::move(target));
}

void Worker::write_part(const std::string& stem, const std::vector<std::string>& names) {
  TetMesh mesh;
  mesh.points = part_.points;
  mesh.dimension = part_.dimension;
  const std::span<const Tet> own = mesh_view().own_tets();
  mesh.tets.assign(own.begin(), own.end());
  std::vector<Field> fields;
  for (const std::string& name : names) fields.push_back({name, 1, {}});
  const auto n = static_cast<std::size_t>(n_components_);
  for (std::size_t v = 0; v < mesh.n_points(); ++v) {
    for (std::size_t c = 0; c < n; ++c) fields[c].values.push_back(values_[v * n + c]);
    const Status status = v < status_.size() ? status_[v] : ghost_status_[v - status_.size()];
    fields[n].values.push_back(static_cast<double>(status));
  }
  write_vtu_file(stem + "." + std::to_string(index().x) + ".vtu", mesh, fields);
}

void Worker::send_values(GroupProxy<ValueKeeper> keepers, GlobalId n_vertices) {
  std::vector<KeptRows> of_pe(static_cast<std::size_t>(n_pes()));
  std::size_t pe = 0;
  for (std::size_t v = 0; v < status_.size(); ++v) {  // by ascending id
    const GlobalId id = part_.point_ids[v];
    while (id >= ValueKeeper::first_of(n_vertices, static_cast<std::int32_t>(pe) + 1, n_pes()))
      ++pe;
    of_pe[pe].vertices.push_back(id);
    const double* const row = values_.data() + v * n_components_;
    of_pe[pe].values.insert(of_pe[pe].values.end(), row, row + n_components_);
  }
  for (std::size_t k = 0; k < of_pe.size(); ++k)
    if (!of_pe[k].vertices.empty())
      keepers[PeId{static_cast<std::int32_t>(k)}].send<&ValueKeeper::take>(std::move(of_pe[k]));
}

}  // namespace tess::m2m
