#include "collide/parallel/voxel_problem.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace tess::collide {
namespace {

bool are_separate(std::span<const ModelSet> natives, std::span<const ModelSet> visitors) {
  std::array<ModelId, most_separate_models> known;
  std::size_t n = 0;
  for (const auto sets : {natives, visitors})
    for (const ModelSet& set : sets) {
      const auto end = known.begin() + static_cast<std::ptrdiff_t>(n);
      if (std::find(known.begin(), end, set.model) != end) continue;
      if (n == known.size()) return false;
      known[n++] = set.model;
    }
  return true;
}

}  // namespace

void ByModel::add(std::span<const search::Entry> entries, const ObjectList& objects) {
  if (entries.empty()) return;
  if (objects.has_one_model()) return add_run(objects.sources().front().model, entries, objects);
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    const ModelId model = objects.model(search::object_of(entries[begin]));
    end = begin + 1;
    while (end < entries.size() && objects.model(search::object_of(entries[end])) == model) ++end;
    add_run(model, entries.subspan(begin, end - begin), objects);
  }
}

void ByModel::add_run(ModelId model, std::span<const search::Entry> entries,
                      const ObjectList& objects) {
  if (sets_.empty()) together_ = true;
  // Of more sets than that, two have one model, or the models are too many for join().
  together_ = together_ && sets_.size() < most_separate_models &&
              std::none_of(sets_.begin(), sets_.end(),
                           [&](const ModelSet& set) { return set.model == model; });
  sets_.push_back({model, &objects, entries});
}

void ByModel::join(ObjectList& merged) {
  if (sets_.empty() || together_) return;
  std::stable_sort(sets_.begin(), sets_.end(),
                   [](const ModelSet& a, const ModelSet& b) { return a.model < b.model; });
  std::swap(sets_, runs_);
  sets_.clear();
  std::size_t n_entries = 0;
  for (const ModelSet& run : runs_) n_entries += run.entries.size();
  copies_.clear();
  copies_.reserve(n_entries);  // the sets refer to them
  for (std::size_t begin = 0, end = 0; begin < runs_.size(); begin = end) {
    const ModelSet& first = runs_[begin];
    bool one_list = true;
    for (end = begin; end < runs_.size() && runs_[end].model == first.model; ++end)
      one_list = one_list && runs_[end].objects == first.objects;
    if (end == begin + 1) {
      sets_.push_back(first);
      continue;
    }
    const std::size_t n_before = copies_.size();
    for (std::size_t r = begin; r < end; ++r) {
      const std::span<const search::Entry> entries = runs_[r].entries;
      if (one_list)
        copies_.insert(copies_.end(), entries.begin(), entries.end());
      else
        merged.append(*runs_[r].objects, entries, copies_);
    }
    sets_.push_back(
        {first.model, one_list ? first.objects : &merged, std::span(copies_).subspan(n_before)});
  }
}

void VoxelProblem::gather(std::span<const Part> parts, WithinModel within_model) {
  merged_.clear();
  objects_ = nullptr;
  within_ = true;
  models_ = {};
  if (within_model == WithinModel::test) return gather_all(parts);
  natives_by_model_.clear();
  visitors_by_model_.clear();
  for (const Part& part : parts) {
    natives_by_model_.add(part.natives(), part.delivery().objects);
    visitors_by_model_.add(part.visitors(), part.delivery().objects);
  }
  const std::span<const ModelSet> natives = natives_by_model_.sets();
  if (!are_separate(natives, visitors_by_model_.sets())) {
    within_ = std::any_of(natives.begin(), natives.end(),
                          [&](const ModelSet& set) { return set.model != natives.front().model; });
    gather_all(parts);
    return set_models();
  }
  natives_by_model_.join(merged_);
  visitors_by_model_.join(merged_);
}

void VoxelProblem::gather_all(std::span<const Part> parts) {
  const Part& first = parts.front();
  if (parts.size() == 1) {
    objects_ = &first.delivery().objects;
    natives_ = first.natives();
    visitors_ = first.visitors();
    return;
  }
  entries_.clear();
  for (const Part& part : parts) merged_.append(part.delivery().objects, part.natives(), entries_);
  const std::size_t n_natives = entries_.size();
  for (const Part& part : parts) merged_.append(part.delivery().objects, part.visitors(), entries_);
  objects_ = &merged_;
  natives_ = std::span(entries_).first(n_natives);
  visitors_ = std::span(entries_).subspan(n_natives);
}

void VoxelProblem::set_models() {
  model_of_.resize(objects_->size());
  for (const auto entries : {natives_, visitors_})
    for (const search::Entry entry : entries) {
      const std::uint32_t object = search::object_of(entry);
      model_of_.data()[object] = static_cast<std::uint32_t>(objects_->model(object));
    }
  models_ = {model_of_.data(), model_of_.size()};
}

}  // namespace tess::collide
