#include "collide/parallel/voxel_sort.hpp"

#include "collide/problem/corners.hpp"
#include "collide/problem/survey.hpp"
#include "runtime/core/uninitialised.hpp"

#include <algorithm>

namespace tess::collide {

void VoxelSort::run(const Plan& plan, const ObjectList& objects) {
  if (objects.size() == 0) return;
  for (Level level = 0; level < most_levels; ++level)
    if (plan.has(level)) sort_level(plan, objects, level);
  note_models(objects);
}

void VoxelSort::clear() {
  records_.clear();
  levels_.clear();
  slots_.clear();
  n_entries_ = 0;
}

template <class IsWanted>
void VoxelSort::spread(std::span<const Aabb> boxes, const VoxelGrid& grid,
                       search::CellNumbers& numbers, const IsWanted& is_wanted) {
  using Corners = search::Corners<3>;
  const Corners corners(numbers.strides());
  const bool is_dense = numbers.is_dense();
  std::size_t n = n_entries_, room = 0;
  const auto make_room = [&](std::size_t more) {
    if (n + more <= room) return;
    cell_of_.reserve(n + more);
    entry_of_.reserve(n + more);
    room = std::min(cell_of_.capacity(), entry_of_.capacity());
  };
  make_room(boxes.size() + boxes.size() / 2);
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (!is_wanted(i)) continue;
    make_room(Corners::room);
    CellRange range;
    if (!grid.find_cells(boxes[i], range)) [[unlikely]]
      range = grid.cells_of(boxes[i]);  // throws
    const auto more = [](std::int32_t lo, std::int32_t hi) {
      return static_cast<std::uint32_t>(hi) - static_cast<std::uint32_t>(lo);
    };
    const std::uint32_t x = more(range.lo.x, range.hi.x), y = more(range.lo.y, range.hi.y),
                        z = more(range.lo.z, range.hi.z);
    if (is_dense && (x | y | z) < 2) [[likely]] {
      n += corners.write(numbers.dense_number(range.lo),
                         static_cast<std::uint32_t>(search::make_entry(i, 0)), x | y << 1 | z << 2,
                         cell_of_.data() + n, entry_of_.data() + n);
      continue;
    }
    make_room(static_cast<std::size_t>(range.n_cells()));
    numbers.for_each(range, [&](std::uint32_t number, std::uint32_t below) {
      cell_of_.data()[n] = number;
      entry_of_.data()[n++] = static_cast<std::uint32_t>(search::make_entry(i, below));
    });
  }
  n_entries_ = n;
}

void VoxelSort::sort_level(const Plan& plan, const ObjectList& objects, Level level) {
  const std::span<const Aabb> boxes = objects.boxes();
  const VoxelGrid grid = plan.grid(level);
  const bool one_level = plan.levels == 1U << level;
  const auto level_of = [&](std::uint32_t i) {
    // A piece may be larger than was expected: it touches some voxels more then.
    return std::min(plan.level_of(search::longest_extent(boxes[i])), plan.highest());
  };
  const auto is_native = [&](std::uint32_t i) { return one_level || level_of(i) == level; };
  const auto is_visitor = [&](std::uint32_t i) { return level_of(i) < level; };
  search::CellNumbers numbers(grid.cells_of(objects.bounds()), static_cast<double>(boxes.size()));

  Sorted& sorted = levels_.emplace_back();
  sorted.begin = n_entries_;
  spread(boxes, grid, numbers, is_native);
  sorted.first_visitor = n_entries_;
  if (!one_level) spread(boxes, grid, numbers, is_visitor);
  sorted.end = n_entries_;
  sorted.first_slot = slots_.size();
  sorted.n_cells = numbers.size();

  slots_.resize(slots_.size() + 2 * sorted.n_cells);
  std::uint32_t* const counts = slots_.data() + sorted.first_slot;
  const std::uint32_t* const cell_of = cell_of_.data();
  for (std::size_t e = sorted.begin; e < sorted.first_visitor; ++e) ++counts[2 * cell_of[e]];
  for (std::size_t e = sorted.first_visitor; e < sorted.end; ++e) ++counts[2 * cell_of[e] + 1];
  for (std::uint32_t number = 0; number < sorted.n_cells; ++number) {
    const std::uint32_t n_natives = counts[2 * number], n_visitors = counts[2 * number + 1];
    if (n_natives + n_visitors == 0) continue;
    const Cell cell = numbers.cell(number);
    records_.push_back({{cell.x, cell.y, cell.z, level}, n_natives, n_visitors, {}, 0, 0});
  }
}

void VoxelSort::note_models(const ObjectList& objects) {
  if (objects.has_one_model()) {
    for (VoxelRecord& record : records_) record.model = objects.model(0);
    return;
  }
  // Per cell, in the order of the slots: 0, a model + 1, or several.
  constexpr std::uint64_t several = ~std::uint64_t{0};
  std::vector<std::uint64_t> models(slots_.size() / 2);
  for (const Sorted& level : levels_) {
    std::uint64_t* const of_cell = models.data() + level.first_slot / 2;
    for (std::size_t e = level.begin; e < level.end; ++e) {
      const auto object = search::object_of(static_cast<search::Entry>(entry_of_.data()[e]));
      const std::uint64_t code = static_cast<std::uint64_t>(objects.model(object)) + 1;
      std::uint64_t& known = of_cell[cell_of_.data()[e]];
      known = known == 0 || known == code ? code : several;
    }
  }
  std::size_t r = 0;
  for (const std::uint64_t known : models) {
    if (known == 0) continue;
    VoxelRecord& record = records_[r++];
    record.several_models = known == several ? 1 : 0;
    record.model = static_cast<ModelId>(known == several ? 0 : known - 1);
  }
}

void VoxelSort::write_sorted(std::span<const VoxelAnswer> answers,
                             std::vector<search::Entry>& sorted) {
  constexpr std::uint32_t nowhere = ~std::uint32_t{0};
  std::uint32_t end = 0;
  std::size_t r = 0;
  for (std::size_t slot = 0; slot < slots_.size(); slot += 2) {
    std::uint32_t &natives = slots_[slot], &visitors = slots_[slot + 1];
    if (natives + visitors == 0) continue;
    if (answers[r++].n_senders == 0) {
      natives = visitors = nowhere;
      continue;
    }
    const std::uint32_t n_natives = natives, n_visitors = visitors;
    natives = end;
    visitors = end + n_natives;
    end += n_natives + n_visitors;
  }
  resize_uninitialised(sorted, end);
  const auto place = [&](std::size_t first_slot, std::size_t begin, std::size_t after) {
    std::uint32_t* const next = slots_.data() + first_slot;
    for (std::size_t e = begin; e < after; ++e) {
      std::uint32_t& at = next[2 * cell_of_.data()[e]];
      if (at != nowhere) sorted[at++] = static_cast<search::Entry>(entry_of_.data()[e]);
    }
  };
  for (const Sorted& level : levels_) {
    place(level.first_slot, level.begin, level.first_visitor);
    place(level.first_slot + 1, level.first_visitor, level.end);
  }
}

}  // namespace tess::collide
