#include "collide/serial/gridding.hpp"

#include "runtime/error.hpp"

#include <algorithm>
#include <limits>

namespace tess {
namespace {

constexpr double kMostCellsOfItem = 1 << 24;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Cell -> a number 0, 1, 2 … in order of first appearance. Open addressing, at most half full.
class CellNumbers {
 public:
  explicit CellNumbers(std::size_t expected) {
    std::size_t n = 64;
    while (n < 2 * expected) n *= 2;
    slots_.assign(n, kNone);
  }
  std::uint32_t number(const Cell& cell) {
    if (2 * cells_.size() >= slots_.size()) grow();
    std::uint32_t& slot = find(cell);
    if (slot == kNone) {
      slot = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back(cell);
    }
    return slot;
  }
  [[nodiscard]] const std::vector<Cell>& cells() const noexcept { return cells_; }

 private:
  std::uint32_t& find(const Cell& cell) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = std::hash<Cell>{}(cell)&mask;
    while (slots_[at] != kNone && cells_[slots_[at]] != cell) at = (at + 1) & mask;
    return slots_[at];
  }
  void grow() {
    slots_.assign(2 * slots_.size(), kNone);
    for (std::uint32_t i = 0; i < cells_.size(); ++i) find(cells_[i]) = i;
  }
  std::vector<std::uint32_t> slots_;
  std::vector<Cell> cells_;
};

/// Calls visit(cell) for each cell of the range, x slowest.
template <class Visit>
void for_each_cell(const CellRange& range, Visit&& visit) {
  for (std::int64_t x = range.lo.x; x <= range.hi.x; ++x)
    for (std::int64_t y = range.lo.y; y <= range.hi.y; ++y)
      for (std::int64_t z = range.lo.z; z <= range.hi.z; ++z)
        visit(Cell{static_cast<std::int32_t>(x),
                   static_cast<std::int32_t>(y),
                   static_cast<std::int32_t>(z)});
}

}  // namespace

VoxelGroups group_by_voxel(std::span<const Item> items, const VoxelGrid& grid, KeepVoxels keep) {
  check_boxes(items);
  CellNumbers numbers(items.size() / 4);
  std::vector<std::uint32_t> voxel_of_entry;
  std::vector<std::uint32_t> n_cells_of_item(items.size());
  std::vector<std::uint32_t> n_entries;
  std::vector<ModelId> model;
  std::vector<char> mixed;
  voxel_of_entry.reserve(2 * items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const CellRange range = grid.cells_of(items[i].box);
    const double n_cells = range.n_cells();
    if (n_cells > kMostCellsOfItem || static_cast<double>(voxel_of_entry.size()) + n_cells >= kNone)
      fail(ErrorCode::bad_value,
           "gridding: object ",
           static_cast<std::uint32_t>(items[i].id.local),
           " of owner ",
           static_cast<std::uint64_t>(items[i].id.owner),
           " touches ",
           n_cells,
           " voxels (at most 2^24 each, 2^32 in all): take larger voxels");
    n_cells_of_item[i] = static_cast<std::uint32_t>(n_cells);
    for_each_cell(range, [&](const Cell& cell) {
      const std::uint32_t v = numbers.number(cell);
      if (v == n_entries.size()) {
        n_entries.push_back(0);
        model.push_back(items[i].id.model);
        mixed.push_back(0);
      }
      ++n_entries[v];
      if (model[v] != items[i].id.model) mixed[v] = 1;
      voxel_of_entry.push_back(v);
    });
  }

  VoxelGroups out;
  std::vector<std::uint32_t> next(n_entries.size(), kNone);  // where a kept voxel's next item goes
  std::uint32_t end = 0;
  for (std::size_t v = 0; v < n_entries.size(); ++v) {
    if (keep == KeepVoxels::of_several_models && mixed[v] == 0) continue;
    out.cells_.push_back(numbers.cells()[v]);
    next[v] = end;
    end += n_entries[v];
    out.first_.push_back(end);
  }
  out.items_.resize(end);
  std::size_t entry = 0;
  for (std::size_t i = 0; i < items.size(); ++i)
    for (std::uint32_t k = 0; k < n_cells_of_item[i]; ++k) {
      std::uint32_t& at = next[voxel_of_entry[entry++]];
      if (at != kNone) out.items_[at++] = static_cast<std::uint32_t>(i);
    }
  return out;
}

}  // namespace tess
