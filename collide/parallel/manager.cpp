#include "collide/parallel/manager.hpp"

#include "collide/parallel/voxel_home.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <span>
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

template <auto F>
auto Manager::sender(std::uint64_t step) {
  return [this, step](std::int32_t to, auto&& bundle) {
    group()[PeId{to}].template send<F>(step, std::move(bundle));
  };
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
  std::vector<std::span<const VoxelRecord>> records;
  for (const auto& parcel : asked) records.push_back(parcel.items);
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
  std::vector<VoxelAnswer> answers(r.sort.records().size());
  for (const auto& [home, items] : r.answers.received()) {
    const std::uint32_t end = r.ends[static_cast<std::size_t>(home)];
    const std::uint32_t* const asked = r.by_home.data() + end - items.size();
    for (std::size_t i = 0; i < items.size(); ++i) answers[asked[i]] = items[i];
  }
  deliver(r, answers);
  rounds_.erase(step);
}

void Manager::deliver(const Round& r, const std::vector<VoxelAnswer>& answers) {
  r.delivery->sorted = r.sort.sorted(answers);
  const std::vector<VoxelRecord>& records = r.sort.records();
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const VoxelRecord& record = records[i];
    const std::uint32_t n = record.n_natives + record.n_visitors;
    const VoxelAnswer& answer = answers[i];
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
