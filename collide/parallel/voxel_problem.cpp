#include "collide/parallel/voxel_problem.hpp"

#include <algorithm>
#include <utility>

namespace tess::collide {

void ByModel::split(std::span<const search::Entry> entries, const ObjectList& objects) {
  sets_.clear();
  bool together = true;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const ModelId model = objects.model(search::object_of(entries[i]));
    if (!sets_.empty() && sets_.back().model == model) {
      Set& last = sets_.back();
      last.entries = {last.entries.data(), last.entries.size() + 1};
      continue;
    }
    together = together && std::none_of(sets_.begin(), sets_.end(),
                                        [&](const Set& set) { return set.model == model; });
    sets_.push_back({model, entries.subspan(i, 1)});
  }
  if (!together) gather(entries);
}

/// One set for all runs of a model.
void ByModel::gather(std::span<const search::Entry> entries) {
  std::stable_sort(sets_.begin(), sets_.end(),
                   [](const Set& a, const Set& b) { return a.model < b.model; });
  copies_.clear();
  copies_.reserve(entries.size());
  std::vector<Set> joined;
  for (const Set& run : sets_) {
    const search::Entry* const at = copies_.data() + copies_.size();
    copies_.insert(copies_.end(), run.entries.begin(), run.entries.end());
    if (!joined.empty() && joined.back().model == run.model) {
      Set& last = joined.back();
      last.entries = {last.entries.data(), last.entries.size() + run.entries.size()};
    } else {
      joined.push_back({run.model, {at, run.entries.size()}});
    }
  }
  sets_ = std::move(joined);
}

void VoxelProblem::gather(std::span<const Part> parts) {
  const Part& first = parts.front();
  if (parts.size() == 1) {
    objects_ = &first.delivery().objects;
    natives_ = first.natives();
    visitors_ = first.visitors();
    return;
  }
  merged_.clear();
  entries_.clear();
  for (const Part& part : parts) part.copy(part.natives(), merged_, entries_);
  const std::size_t n_natives = entries_.size();
  for (const Part& part : parts) part.copy(part.visitors(), merged_, entries_);
  objects_ = &merged_;
  natives_ = std::span(entries_).first(n_natives);
  visitors_ = std::span(entries_).subspan(n_natives);
}

}  // namespace tess::collide
