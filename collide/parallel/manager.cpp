#include "collide/parallel/manager.hpp"

#include "collide/parallel/voxel_home.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace tess::collide {

void Manager::prepare(std::uint64_t step, const Callback<Summary>& target) {
  Prepared& prepared = prepared_[step];
  prepared.objects = std::exchange(pending_, {});
  const ObjectList& objects = prepared.objects;
  Summary summary;
  for (const Aabb& box : objects.boxes()) summary.add(box);
  objects.for_each_model([&](ModelId model) { summary.add(model); });
  summary.add_sample(objects.boxes(), n_pes());
  prepared.bounds = summary.bounds;
  contribute(in_order(JoinSummaries{}), std::move(summary), target);
}

void Manager::begin(std::uint64_t step, const Plan& plan, const Report& report) {
  Prepared prepared = std::move(prepared_.extract(step).mapped());
  last_ = {};
  if (plan.nothing) {
    last_.n_left_out = prepared.objects.boxes().size();
    return;
  }
  last_.voxel_size = std::min({plan.size[0], plan.size[1], plan.size[2]});
  last_.n_levels = static_cast<std::uint64_t>(std::popcount(plan.levels));
  Round& r = round(step);
  r.delivery = std::make_shared<Delivery>(Delivery{plan, report, std::move(prepared.objects), {}});
  r.sort = VoxelSort(plan, r.delivery->objects, prepared.bounds);
  const std::vector<VoxelRecord>& all = r.sort.records();
  const auto n = static_cast<std::size_t>(n_pes());
  std::vector<std::vector<VoxelRecord>> records(n);
  r.records_of.resize(n);
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const std::size_t home = home_of(all[i].voxel, n);
    records[home].push_back(all[i]);
    r.records_of[home].push_back(i);
  }
  r.answers.resize(all.size());
  const WithinModel within_model = plan.rules.within_model;
  for (std::size_t home = 0; home < n; ++home)
    group()[PeId{static_cast<std::int32_t>(home)}].send<&Manager::receive_records>(
        step, pe(), within_model, std::move(records[home]));
}

Manager::Round& Manager::round(std::uint64_t step) {
  Round& r = rounds_[step];
  r.received.resize(static_cast<std::size_t>(n_pes()));
  return r;
}

void Manager::receive_records(std::uint64_t step, PeId from, WithinModel within_model,
                              std::vector<VoxelRecord> records) {
  Round& r = round(step);
  r.received[static_cast<std::size_t>(from.value)] = std::move(records);
  if (++r.n_received != n_pes()) return;
  std::vector<std::vector<VoxelAnswer>> answers = answers_to(r.received, within_model);
  for (std::int32_t to = 0; to < n_pes(); ++to)
    group()[PeId{to}].send<&Manager::receive_answers>(
        step, pe(), std::move(answers[static_cast<std::size_t>(to)]));
}

void Manager::receive_answers(std::uint64_t step, PeId home, std::vector<VoxelAnswer> answers) {
  Round& r = round(step);
  const std::vector<std::uint32_t>& asked = r.records_of[static_cast<std::size_t>(home.value)];
  for (std::size_t i = 0; i < asked.size(); ++i) r.answers[asked[i]] = answers[i];
  if (++r.n_answers != n_pes()) return;
  deliver(r);
  rounds_.erase(step);  // its own home has answered, too
}

void Manager::deliver(Round& r) {
  r.delivery->sorted = r.sort.sorted(r.answers);
  const std::vector<VoxelRecord>& records = r.sort.records();
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const VoxelRecord& record = records[i];
    const std::uint32_t n = record.n_natives + record.n_visitors;
    const VoxelAnswer& answer = r.answers[i];
    if (answer.n_senders == 0) {
      last_.n_left_out += n;
      continue;
    }
    last_.n_entries += n;
    last_.n_voxels += answer.makes_it;
    Part part(r.delivery, begin, record.n_natives, record.n_visitors);
    const std::uint32_t n_senders = answer.n_senders;
    if (answer.makes_it != 0) {
      voxels_[record.voxel].send_or_create_here<&Voxel::add>(std::move(part), n_senders);
    } else {
      voxels_[record.voxel].send<&Voxel::add>(std::move(part), n_senders);
    }
    begin += n;
  }
}

}  // namespace tess::collide
