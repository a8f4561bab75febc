// The serial problem of a voxel: the objects of its parts, and which sets of them are searched.
#pragma once

#include "collide/parallel/part.hpp"
#include "collide/search/choose_grid.hpp"

#include <span>
#include <vector>

namespace tess::collide {

using Problem = search::Problem<double, 3>;

/// Entries by model. They are copied only if the objects of a model do not stand together.
class ByModel {
 public:
  struct Set {
    ModelId model;
    std::span<const search::Entry> entries;
  };

  void split(std::span<const search::Entry> entries, const ObjectList& objects);
  [[nodiscard]] std::span<const Set> sets() const { return sets_; }

 private:
  void gather(std::span<const search::Entry> entries);

  std::vector<Set> sets_;
  std::vector<search::Entry> copies_;
};

/// Keeps its memory from voxel to voxel.
class VoxelProblem {
 public:
  /// The parts remain where they are until the search is done.
  void gather(std::span<const Part> parts);

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
  std::vector<search::Entry> entries_;
  ByModel natives_by_model_, visitors_by_model_;
};

}  // namespace tess::collide
