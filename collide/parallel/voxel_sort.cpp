#include "collide/parallel/voxel_sort.hpp"

#include "collide/search/survey.hpp"
#include "collide/serial/cell_numbers.hpp"

namespace tess::collide {

VoxelSort::VoxelSort(const Plan& plan, const ObjectList& objects) {
  for (Level level = 0; level < most_levels; ++level)
    if (plan.has(level)) sort_level(plan, objects, level);
  note_models(objects);
}

void VoxelSort::sort_level(const Plan& plan, const ObjectList& objects, Level level) {
  const std::vector<Aabb>& boxes = objects.boxes();
  const VoxelGrid grid = plan.grid(level);
  const bool one_level = plan.levels == 1U << level;
  const auto level_of = [&](std::uint32_t i) {
    return one_level ? level : plan.level_of(search::longest_extent(boxes[i]));
  };
  const auto n = static_cast<std::uint32_t>(boxes.size());
  serial::CellBounds bounds;
  for (std::uint32_t i = 0; i < n; ++i)
    if (level_of(i) <= level)
      bounds.add(serial::cells_of({boxes[i], objects.id(i)}, grid), {boxes[i], objects.id(i)});
  serial::CellNumbers numbers(bounds);
  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> record_of(numbers.size(), none);  // per number
  const auto needed = n_entries_ + static_cast<std::size_t>(bounds.n_entries);
  slot_of_.resize(needed);
  entry_of_.resize(needed);
  for (std::uint32_t i = 0; i < n; ++i) {
    const Level at = level_of(i);
    if (at > level) continue;
    const std::uint32_t visits = at == level ? 0 : 1;
    const CellRange range = serial::cells_of({boxes[i], objects.id(i)}, grid);
    numbers.for_each(range, [&](std::uint32_t number, std::uint32_t below) {
      if (number >= record_of.size()) record_of.resize(2 * number + 1, none);
      std::uint32_t& r = record_of[number];
      if (r == none) {
        r = static_cast<std::uint32_t>(records_.size());
        const Cell cell = numbers.cell(number);
        records_.push_back({{cell.x, cell.y, cell.z, level}});
      }
      ++(visits != 0 ? records_[r].n_visitors : records_[r].n_natives);
      slot_of_.data()[n_entries_] = 2 * r + visits;
      entry_of_.data()[n_entries_++] = static_cast<std::uint32_t>(search::make_entry(i, below));
    });
  }
}

void VoxelSort::note_models(const ObjectList& objects) {
  if (objects.boxes().empty()) return;
  if (objects.has_one_model()) {
    for (VoxelRecord& record : records_) record.model = objects.model(0);
    return;
  }
  std::vector<bool> seen(records_.size());
  for (std::size_t e = 0; e < n_entries_; ++e) {
    const std::uint32_t r = slot_of_.data()[e] / 2;
    const ModelId model =
        objects.model(search::object_of(static_cast<search::Entry>(entry_of_.data()[e])));
    if (!seen[r]) {
      seen[r] = true;
      records_[r].model = model;
    } else if (records_[r].model != model) {
      records_[r].several_models = 1;
    }
  }
}

std::vector<search::Entry> VoxelSort::sorted(std::span<const VoxelAnswer> answers) const {
  constexpr std::uint32_t nowhere = ~std::uint32_t{0};
  std::vector<std::uint32_t> next(2 * records_.size(), nowhere);  // per slot: the next position
  std::uint32_t end = 0;
  for (std::size_t r = 0; r < records_.size(); ++r) {
    if (answers[r].n_senders == 0) continue;
    next[2 * r] = end;
    next[2 * r + 1] = end += records_[r].n_natives;
    end += records_[r].n_visitors;
  }
  std::vector<search::Entry> out(end);
  for (std::size_t e = 0; e < n_entries_; ++e) {
    std::uint32_t& place = next[slot_of_.data()[e]];
    if (place != nowhere) out[place++] = static_cast<search::Entry>(entry_of_.data()[e]);
  }
  return out;
}

}  // namespace tess::collide
