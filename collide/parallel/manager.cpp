#include "collide/parallel/manager.hpp"

#include "collide/parallel/pair_search.hpp"
#include "collide/parallel/voxel_home.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <span>
#include <utility>

namespace tess::collide {

void refuse_submitted(std::size_t n) {
  if (n != 0)
    fail(ErrorCode::bad_value, n,
         " objects were submitted to a collider that has not run since: run() it before the "
         "checkpoint");
}

ObjectList& Manager::pending() {
  if (pending_ == nullptr) pending_ = pool_.take();
  return pending_->objects;
}

void Manager::prepare(std::uint64_t step, std::size_t n_sampled, const ArrayProxy<Voxel>& voxels,
                      const Callback<Summary>& target) {
  voxels_ = voxels;
  contribute(JoinSummaries{}, Summary(pending(), pe().value, n_sampled), target);
  round(step).delivery = std::move(pending_);
}

Summary Manager::take(std::uint64_t step, ObjectList objects, std::size_t n_sampled) {
  const std::shared_ptr<Delivery> delivery = pool_.take();
  delivery->objects = std::move(objects);
  round(step).delivery = delivery;
  return {delivery->objects, pe().value, n_sampled};
}

template <auto F>
auto Manager::sender(std::uint64_t step) {
  return [this, step](std::int32_t to, auto&& bundle) {
    group()[PeId{to}].template send<F>(step, std::move(bundle));
  };
}

void Manager::begin(std::uint64_t step, const Plan& plan, const HitReceivers& receivers) {
  Round& r = round(step);
  if (plan.nothing) {
    last_ = {};
    if (plan.rules.within_model == WithinModel::skip)
      last_.grid.n_entries = last_.grid.n_left_out = r.delivery->objects.size();
    rounds_.erase(step);
    return;
  }
  r.statistics.grid.voxel_size = std::ranges::max(plan.grid(plan.lowest()).size());
  r.statistics.grid.n_levels = static_cast<std::uint64_t>(std::popcount(plan.levels));
  r.delivery->plan = plan;
  r.delivery->receivers = receivers;
  r.delivery->managers = group();
  if (plan.pieces.used) {
    r.delivery->objects.divide(plan.pieces.frame, plan.pieces.longest, pe());
    r.statistics.n_pieces = r.delivery->objects.size();
  }
  r.delivery->sort.run(plan, r.delivery->objects);
  charge_each(plan.costs.gridding, r.delivery->sort.n_entries());
  if (machine().n_processes() > 1)
    r.delivery->sort.note_places(
        [&](const Index4& voxel) { return voxels_.local(voxel) != nullptr; });
  const std::vector<VoxelRecord>& all = r.delivery->sort.records();
  const auto n = static_cast<std::size_t>(n_pes());
  std::vector<std::uint32_t> home(all.size());
  r.ends.assign(n, 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    home[i] = static_cast<std::uint32_t>(home_of(all[i].voxel, n));
    ++r.ends[home[i]];
  }
  std::exclusive_scan(r.ends.begin(), r.ends.end(), r.ends.begin(), 0U);
  r.by_home.resize(all.size());
  std::vector<VoxelRecord> sorted(all.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const std::uint32_t place = r.ends[home[i]]++;
    r.by_home[place] = i;
    sorted[place] = all[i];
  }
  for (std::size_t to = 0, begin = 0; to < n; begin = r.ends[to++])
    if (begin != r.ends[to])
      r.records.put(static_cast<std::int32_t>(to),
                    std::span(sorted).subspan(begin, r.ends[to] - begin));
  r.records.start(sender<&Manager::receive_records>(step));
  answer_if_asked(step, r);
}

Manager::Round& Manager::round(std::uint64_t step) {
  return rounds_.try_emplace(step, pe().value, n_pes()).first->second;
}

void Manager::receive_records(std::uint64_t step, const Bundle<VoxelRecord>& bundle) {
  Round& r = round(step);
  r.records.receive(bundle, sender<&Manager::receive_records>(step));
  answer_if_asked(step, r);
}

void Manager::answer_if_asked(std::uint64_t step, Round& r) {
  if (!r.records.is_done()) return;
  const auto asked = r.records.received();
  std::vector<RecordsOf> records;
  std::size_t n_compared = 0;
  for (const auto& parcel : asked) {
    records.push_back({PeId{parcel.from}, parcel.items});
    if (asked.size() > 1) n_compared += parcel.items.size();
  }
  charge_each(r.delivery->plan.costs.record, n_compared);
  const auto answers = answers_to(records, r.delivery->plan.rules.within_model);
  for (std::size_t i = 0; i < asked.size(); ++i) r.answers.put(asked[i].from, answers[i]);
  r.answers.start(sender<&Manager::receive_answers>(step));
  deliver_if_answered(step, r);
}

void Manager::receive_answers(std::uint64_t step, const Bundle<VoxelAnswer>& bundle) {
  Round& r = round(step);
  r.answers.receive(bundle, sender<&Manager::receive_answers>(step));
  deliver_if_answered(step, r);
}

void Manager::deliver_if_answered(std::uint64_t step, Round& r) {
  if (!r.answers.is_done()) return;
  r.answer_of.resize(r.delivery->sort.records().size());
  for (const auto& [home, items] : r.answers.received()) {
    const std::uint32_t end = r.ends[static_cast<std::size_t>(home)];
    const std::uint32_t* const asked = r.by_home.data() + end - items.size();
    for (std::size_t i = 0; i < items.size(); ++i) r.answer_of[asked[i]] = items[i];
  }
  r.delivery->sort.write_sorted(r.answer_of, r.delivery->sorted);
  deliver(step);
}

void Manager::deliver(std::uint64_t step) {
  // The hits of so many entries fit into the cache until their owners receive them.
  constexpr std::uint32_t most_entries = 4096;
  Round& r = round(step);
  const std::vector<VoxelRecord>& records = r.delivery->sort.records();
  const std::size_t first = r.n_delivered;
  const std::uint32_t first_begin = r.begin, end = r.begin + most_entries;
  std::map<PeId, Shipment> shipments;
  for (; r.n_delivered < records.size() && r.begin < end; ++r.n_delivered) {
    const VoxelRecord& record = records[r.n_delivered];
    const std::uint32_t n = record.n_natives + record.n_visitors;
    const VoxelAnswer& answer = r.answer_of[r.n_delivered];
    r.statistics.grid.n_entries += n;
    if (answer.n_senders == 0) {
      r.statistics.grid.n_left_out += n;
      continue;
    }
    r.statistics.grid.n_voxels += answer.maker == pe() ? 1U : 0U;
    if (!machine().same_process(answer.maker, pe())) {
      shipments[answer.maker].add(
          {record.voxel, record.n_natives, record.n_visitors, answer.n_senders},
          std::span(r.delivery->sorted).subspan(r.begin, n));
      charge_each(r.delivery->plan.costs.copy, n);
    }
    r.begin += n;
  }
  // What has the longest way leaves first.
  for (auto& [to, shipment] : shipments) {
    shipment.pack(*r.delivery);
    group()[to].send<&Manager::receive_shipment>(std::move(shipment));
  }
  deliver_here(r, first, first_begin);
  if (r.n_delivered < records.size()) {
    group()[pe()].send<&Manager::deliver>(step);
    return;
  }
  last_ = r.statistics;
  rounds_.erase(step);
}

void Manager::deliver_here(const Round& r, std::size_t first, std::uint32_t begin) {
  for (std::size_t i = first; i < r.n_delivered; ++i) {
    const VoxelRecord& record = r.delivery->sort.records()[i];
    const VoxelAnswer& answer = r.answer_of[i];
    if (answer.n_senders == 0) continue;
    Part part(r.delivery, begin, record.n_natives, record.n_visitors);
    begin += record.n_natives + record.n_visitors;
    if (answer.maker == pe())
      voxels_[record.voxel].send_or_create_here<&Voxel::add>(std::move(part), answer.n_senders);
    else if (machine().same_process(answer.maker, pe()))
      voxels_[record.voxel].send<&Voxel::add>(std::move(part), answer.n_senders);
  }
}

/// If a voxel was moved, its objects follow it.
void Manager::receive_shipment(const Shipment& shipment) {
  shipment.for_each([&](const Shipment::Stop& stop, Part part) {
    charge_each(part.delivery().plan.costs.copy, part.entries().size());
    voxels_[stop.voxel].send_or_create_here<&Voxel::add>(std::move(part), stop.n_senders);
  });
}

Task Manager::search_in_portions(std::vector<Part> parts) {
  if (is_searching_) {
    Future<void> turn;
    turns_.push_back(turn.callback());
    co_await turn;
  }
  is_searching_ = true;
  PortionSearch search(std::move(parts));
  for (HitSorter hits = search.next(); !hits.empty(); hits = search.next())
    co_await epoch([&] { hits.send(search.call()); });
  if (turns_.empty()) {
    is_searching_ = false;
  } else {
    const auto next = std::move(turns_.front());
    turns_.pop_front();
    next();
  }
}

}  // namespace tess::collide
