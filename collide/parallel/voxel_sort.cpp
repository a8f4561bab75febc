#include "collide/parallel/voxel_sort.hpp"

#include "collide/search/survey.hpp"
#include "collide/search/wide.hpp"

#include <algorithm>

namespace tess::collide {

VoxelSort::VoxelSort(const Plan& plan, const ObjectList& objects, const Aabb& bounds) {
  if (objects.boxes().empty()) return;
  for (Level level = 0; level < most_levels; ++level)
    if (plan.has(level)) sort_level(plan, objects.boxes(), bounds, level);
  note_models(objects);
}

namespace {

/// As find_cells(), for objects that a plan has accepted.
CellRange cells_in(const VoxelGrid& grid, const Aabb& box) {
  CellRange range;
  if (!grid.find_cells(box, range)) [[unlikely]]
    range = grid.cells_of(box);  // throws
  return range;
}

}  // namespace

template <class IsWanted>
void VoxelSort::spread(std::span<const Aabb> boxes, const VoxelGrid& grid,
                       serial::CellNumbers& numbers, const IsWanted& is_wanted) {
  using Corners = search::Corners<3>;
  const Corners corners(numbers.strides());
  const bool is_dense = numbers.is_dense();
  std::size_t n = n_entries_, room = 0;
  const auto make_room = [&](std::size_t more) {
    if (n + more <= room) return;
    slot_of_.reserve(n + more);
    entry_of_.reserve(n + more);
    room = std::min(slot_of_.capacity(), entry_of_.capacity());
  };
  make_room(boxes.size() + boxes.size() / 2);
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (!is_wanted(i)) continue;
    make_room(Corners::room);
    const CellRange range = cells_in(grid, boxes[i]);
    const auto more = [](std::int32_t lo, std::int32_t hi) {
      return static_cast<std::uint32_t>(hi) - static_cast<std::uint32_t>(lo);
    };
    const std::uint32_t x = more(range.lo.x, range.hi.x), y = more(range.lo.y, range.hi.y),
                        z = more(range.lo.z, range.hi.z);
    if (is_dense && (x | y | z) < 2) [[likely]] {
      n += corners.write(numbers.dense_number(range.lo),
                         static_cast<std::uint32_t>(search::make_entry(i, 0)), x | y << 1 | z << 2,
                         slot_of_.data() + n, entry_of_.data() + n);
      continue;
    }
    make_room(static_cast<std::size_t>(range.n_cells()));
    numbers.for_each(range, [&](std::uint32_t number, std::uint32_t below) {
      slot_of_.data()[n] = number;
      entry_of_.data()[n++] = static_cast<std::uint32_t>(search::make_entry(i, below));
    });
  }
  n_entries_ = n;
}

void VoxelSort::sort_level(const Plan& plan, const std::vector<Aabb>& boxes, const Aabb& bounds,
                           Level level) {
  const VoxelGrid grid = plan.grid(level);
  const bool one_level = plan.levels == 1U << level;
  const auto level_of = [&](std::uint32_t i) {
    return plan.level_of(search::longest_extent(boxes[i]));
  };
  const auto is_native = [&](std::uint32_t i) { return one_level || level_of(i) == level; };
  const auto is_visitor = [&](std::uint32_t i) { return level_of(i) < level; };
  serial::CellNumbers numbers(grid.cells_of(bounds), static_cast<double>(boxes.size()));

  const std::size_t begin = n_entries_;
  spread(boxes, grid, numbers, is_native);
  const std::size_t first_visitor = n_entries_;
  if (!one_level) spread(boxes, grid, numbers, is_visitor);

  // Per number: how many natives and visitors; then the position of the record.
  std::vector<std::array<std::uint32_t, 2>> counts(numbers.size());
  std::uint32_t* const slot_of = slot_of_.data();
  for (std::size_t e = begin; e < first_visitor; ++e) ++counts[slot_of[e]][0];
  for (std::size_t e = first_visitor; e < n_entries_; ++e) ++counts[slot_of[e]][1];
  for (std::uint32_t number = 0; number < counts.size(); ++number) {
    const auto [n_natives, n_visitors] = counts[number];
    if (n_natives + n_visitors == 0) continue;
    counts[number][0] = static_cast<std::uint32_t>(records_.size());
    const Cell cell = numbers.cell(number);
    records_.push_back({{cell.x, cell.y, cell.z, level}, n_natives, n_visitors, {}, 0});
  }
  for (std::size_t e = begin; e < n_entries_; ++e)
    slot_of[e] = 2 * counts[slot_of[e]][0] + (e < first_visitor ? 0U : 1U);
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
