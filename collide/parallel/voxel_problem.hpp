// The serial problem of a voxel: the objects of its parts, and which sets of them are searched.
#pragma once

#include "collide/parallel/part.hpp"
#include "collide/problem/choose_grid.hpp"
#include "collide/problem/scratch.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::collide {

using Problem = search::Problem<double, 3>;

/// A search of a voxel, and the lists that have the objects of its two sets.
struct PairSets {
  Problem problem;
  const ObjectList* of_a = nullptr;
  const ObjectList* of_b = nullptr;
};

/// Some objects of a list, which have one model.
struct ModelSet {
  ModelId model{};
  const ObjectList* objects = nullptr;
  std::span<const search::Entry> entries;
};

/// So many models in a voxel are searched pair by pair, where their objects are. More are searched
/// together, because their pairs would be too many searches.
inline constexpr std::size_t most_separate_models = 8;

/// Objects of several parts by model. Entries are copied only if the objects of a model do not
/// stand together, and boxes only if they stand in several lists. So a voxel of two planes, each on
/// its own PE, copies nothing.
class ByModel {
 public:
  /// Starts again.
  void clear() { sets_.clear(); }
  void add(std::span<const search::Entry> entries, const ObjectList& objects);
  /// Makes one set per model. Boxes are copied to `merged`.
  void join(ObjectList& merged);
  [[nodiscard]] std::span<const ModelSet> sets() const { return sets_; }

 private:
  void add_run(ModelId model, std::span<const search::Entry> entries, const ObjectList& objects);

  std::vector<ModelSet> sets_, runs_;
  std::vector<search::Entry> copies_;
  bool together_ = true;  // each model has one set
};

/// Keeps its memory from voxel to voxel.
class VoxelProblem {
 public:
  /// The parts remain where they are until the search is done.
  void gather(std::span<const Part> parts, WithinModel within_model);

  /// Calls run(sets) for the sets whose pairs count: those of different models, or all. With
  /// models(), only their pairs of different models count.
  template <class Run>
  void for_each_search(const Run& run) const {
    if (objects_ != nullptr) {
      const Aabb* const boxes = objects_->boxes().data();
      return run(PairSets{{boxes, boxes, natives_, visitors_, within_}, objects_, objects_});
    }
    const auto run_pair = [&](const ModelSet& a, const ModelSet& b) {
      const Aabb* const boxes_a = a.objects->boxes().data();
      const Aabb* const boxes_b = b.objects->boxes().data();
      run(PairSets{{boxes_a, boxes_b, a.entries, b.entries, false}, a.objects, b.objects});
    };
    const auto natives = natives_by_model_.sets();
    for (std::size_t m = 0; m < natives.size(); ++m) {
      // With the natives of the models after it, and with the visitors of all others.
      for (std::size_t other = m + 1; other < natives.size(); ++other)
        run_pair(natives[m], natives[other]);
      for (const ModelSet& visiting : visitors_by_model_.sets())
        if (visiting.model != natives[m].model) run_pair(natives[m], visiting);
    }
  }

  /// By the positions of the objects in their list, if many models are searched together; or none.
  [[nodiscard]] std::span<const std::uint32_t> models() const { return models_; }
  /// The boxes that were copied, because a set stood in the lists of several PEs.
  [[nodiscard]] std::size_t n_copied() const { return merged_.size(); }

 private:
  void gather_all(std::span<const Part> parts);
  void set_models();

  const ObjectList* objects_ = nullptr;  // of all parts, if they are searched together
  std::span<const search::Entry> natives_, visitors_;
  bool within_ = true;                     // natives_ have pairs that count
  std::span<const std::uint32_t> models_;  // in model_of_, where the voxel has an object
  search::Scratch<std::uint32_t> model_of_;
  ObjectList merged_;
  std::vector<search::Entry> entries_;
  ByModel natives_by_model_, visitors_by_model_;
};

}  // namespace tess::collide
