#include "collide/parallel/voxel.hpp"

#include "collide/parallel/hit_sorter.hpp"
#include "collide/search/costs.hpp"
#include "collide/search/voxel_search.hpp"

#include <algorithm>
#include <utility>

namespace tess::collide {
namespace {

using Search = search::VoxelSearch<double, 3>;
using Problem = search::Problem<double, 3>;
using Entries = std::vector<search::Entry>;

/// Entries by model. They are copied only if the objects of a model do not stand together.
class ByModel {
 public:
  struct Set {
    ModelId model;
    std::span<const search::Entry> entries;
  };

  void split(std::span<const search::Entry> entries, const ObjectList& objects) {
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
  [[nodiscard]] std::span<const Set> sets() const { return sets_; }

 private:
  /// One set for all runs of a model.
  void gather(std::span<const search::Entry> entries) {
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

  std::vector<Set> sets_;
  Entries copies_;
};

/// The objects of a voxel, and how they are searched. The memory is kept from voxel to voxel.
class VoxelProblem {
 public:
  /// The parts remain where they are until the search is done.
  void gather(std::span<const Part> parts) {
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

  /// Calls run(problem) for the sets whose pairs count: those of different models, or all.
  template <class Run>
  void for_each_search(WithinModel within_model, const Run& run) {
    const Aabb* const boxes = objects_->boxes().data();
    if (within_model == WithinModel::test)
      return run(Problem{boxes, boxes, natives_, visitors_, true});
    natives_by_model_.split(natives_, *objects_);
    visitors_by_model_.split(visitors_, *objects_);
    const auto natives = natives_by_model_.sets();
    for (std::size_t m = 0; m < natives.size(); ++m) {
      // With the natives of the models after it, and with the visitors of all others.
      for (std::size_t other = m + 1; other < natives.size(); ++other)
        run(Problem{boxes, boxes, natives[m].entries, natives[other].entries, false});
      for (const ByModel::Set& visiting : visitors_by_model_.sets())
        if (visiting.model != natives[m].model)
          run(Problem{boxes, boxes, natives[m].entries, visiting.entries, false});
    }
  }
  [[nodiscard]] const ObjectList& objects() const { return *objects_; }

 private:
  const ObjectList* objects_ = nullptr;
  std::span<const search::Entry> natives_, visitors_;
  ObjectList merged_;
  Entries entries_;
  ByModel natives_by_model_, visitors_by_model_;
};

/// The scratch memory of a thread.
struct Scratch {
  VoxelProblem problem;
  Search search{{}, false, {nullptr, nullptr}};
};

/// Sends the pairs to the owners of the objects.
struct Receiver {
  const ObjectList& objects;
  const Report& report;
  HitSorter hits;

  static void call(void* context, const std::uint32_t* first, const std::uint32_t* second,
                   std::size_t n, bool /*swapped*/) {
    auto& self = *static_cast<Receiver*>(context);
    self.hits.add(self.objects, first, second, n, self.report.only);
  }
};

void search_pairs(std::span<const Part> parts) {
  static thread_local Scratch scratch;
  const Delivery& delivery = parts.front().delivery();
  const PairRules rules = delivery.plan.rules;
  scratch.problem.gather(parts);
  Receiver receiver{scratch.problem.objects(), delivery.report, {}};
  PairOptions options;
  options.touching = rules.touching;
  scratch.search.restart(options, false, {&receiver, &Receiver::call});
  scratch.problem.for_each_search(rules.within_model, [&](const Problem& problem) {
    // Few objects are compared wherever they are.
    const bool is_small = problem.a.size() + problem.b.size() <= search::costs::few_objects;
    const Aabb bounds = is_small ? Aabb{} : search::bounds_of(problem.boxes_a, problem.a);
    static_cast<void>(scratch.search.solve(problem, bounds, false));
  });
  receiver.hits.send(delivery.report.call);
}

}  // namespace

void Voxel::add(Part part, std::uint32_t n_senders) {
  is_idle_ = false;
  const std::uint64_t step = part.delivery().plan.step;
  std::vector<Part>& parts = waiting_[step];
  parts.push_back(std::move(part));
  if (parts.size() < n_senders) return;
  search_pairs(parts);
  waiting_.erase(step);
}

void Voxel::retire() {
  if (is_idle_) {
    destroy();
  } else {
    is_idle_ = true;
  }
}

}  // namespace tess::collide
