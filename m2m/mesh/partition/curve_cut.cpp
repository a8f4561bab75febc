#include "m2m/mesh/partition/curve_cut.hpp"

#include "runtime/core/hilbert.hpp"

#include <algorithm>

namespace tess::m2m {
namespace {

constexpr int table_levels = 4;
constexpr int further_levels = 2;

/// The first position of a cell of `level`, at the last level.
std::uint64_t begin_of(std::uint64_t cell, int level) {
  return cell << static_cast<unsigned>(3 * (hilbert_levels - level));
}

/// Positions on the curve of level `levels`. Tetrahedra that follow each other are often in one
/// cell.
class Positions {
 public:
  explicit Positions(int levels)
      : levels_(levels), shift_(3U * static_cast<unsigned>(hilbert_levels - levels)) {}
  [[nodiscard]] std::uint64_t of(std::uint64_t cell) {
    if (const std::uint64_t outer = cell >> shift_; outer != outer_) {
      outer_ = outer;
      position_ = hilbert_position(outer, levels_);
    }
    return position_;
  }

 private:
  int levels_;
  unsigned shift_;
  std::uint64_t outer_ = ~std::uint64_t{0};  // no cell has this
  std::uint64_t position_ = 0;
};

}  // namespace

CurveCut::CurveCut(std::uint64_t n_tets, std::int32_t n_parts)
    : n_tets_(n_tets),
      n_parts_(n_parts),
      cuts_(static_cast<std::size_t>(n_parts) - 1),
      n_before_cuts_(cuts_.size()) {
  if (n_parts == 1) return;
  first_ = {0};
  end_ = {n_parts - 1};
  open_ = {0};
  before_ = {0};
}

int CurveCut::next_level() const {
  // So fine that one round is enough for a mesh of even density, if its parts are not too many: at
  // least 32 cells per part.
  if (level_ == 0) return n_parts_ <= 128 ? 4 : 5;
  return std::min(level_ + further_levels, hilbert_levels);
}

/// How many tetrahedra should be before a cut.
std::uint64_t CurveCut::target(std::int32_t cut) const {
  const auto parts = static_cast<std::uint64_t>(n_parts_);
  const std::uint64_t each = n_tets_ / parts, rest = n_tets_ % parts;
  const auto i = static_cast<std::uint64_t>(cut) + 1;
  return i * each + i * rest / parts;
}

CellCounts CurveCut::counts(std::span<const std::uint64_t> cells) const {
  if (is_done()) return {};
  const int next = next_level();
  const unsigned bits = 3U * static_cast<unsigned>(next - level_);
  constexpr std::size_t size = CellCounts::block_size;
  constexpr std::size_t absent = 0;
  std::vector<std::size_t> end_of_block((open_.size() << bits) / size + 1, absent);
  std::vector<std::uint32_t> counts;  // of blocks in the order in which they appear
  Positions positions(next);
  for (const std::uint64_t cell : cells) {
    const std::uint64_t position = positions.of(cell);
    const std::uint64_t outer = position >> bits;
    const auto open = std::lower_bound(open_.begin(), open_.end(), outer);
    if (open == open_.end() || *open != outer) continue;
    const auto k = static_cast<std::uint64_t>(open - open_.begin());
    const std::uint64_t at = k << bits | (position & ((std::uint64_t{1} << bits) - 1));
    std::size_t& end = end_of_block[at / size];
    if (end == absent) {
      counts.resize(counts.size() + size);
      end = counts.size();
    }
    ++counts[end - size + at % size];
  }
  CellCounts sorted;
  sorted.counts.reserve(counts.size());
  for (std::size_t block = 0; block < end_of_block.size(); ++block) {
    if (end_of_block[block] == absent) continue;
    sorted.blocks.push_back(static_cast<std::uint32_t>(block));
    const auto end = counts.begin() + static_cast<std::ptrdiff_t>(end_of_block[block]);
    sorted.counts.insert(sorted.counts.end(), end - size, end);
  }
  return sorted;
}

void CurveCut::refine(const CellCounts& all) {
  const int next = next_level();
  const unsigned bits = 3U * static_cast<unsigned>(next - level_);
  const std::uint64_t enough = n_tets_ / static_cast<std::uint64_t>(n_parts_) / 16;
  constexpr std::size_t size = CellCounts::block_size;
  const std::size_t n_cells = open_.size() << bits;
  std::vector<std::uint32_t> spread;
  std::span<const std::uint32_t> counts(all.counts);
  if (counts.size() < n_cells) {  // some blocks have none
    spread.resize((n_cells / size + 1) * size);
    for (std::size_t block = 0; block < all.blocks.size(); ++block)
      std::copy_n(all.counts.begin() + static_cast<std::ptrdiff_t>(block * size), size,
                  spread.begin() + static_cast<std::ptrdiff_t>(all.blocks[block] * size));
    counts = spread;
  }
  const CurveCut last = *this;
  first_.clear();
  end_.clear();
  open_.clear();
  before_.clear();
  for (std::size_t k = 0; k < last.open_.size(); ++k) {
    const std::int32_t end = last.end_[k];
    std::int32_t cut = last.first_[k];
    std::uint64_t before = last.before_[k], wanted = target(cut);
    for (std::uint64_t i = 0; i < std::uint64_t{1} << bits && cut < end; ++i) {
      const std::uint64_t after = before + counts[k << bits | i];
      if (after <= wanted) {  // most cells have no cut
        before = after;
        continue;
      }
      const std::uint64_t cell = last.open_[k] << bits | i;
      const bool opens = counts[k << bits | i] > enough && next < hilbert_levels;
      for (bool is_open = false; cut < end && wanted < after; wanted = target(++cut)) {
        if (opens && wanted > before) {
          if (!is_open) {
            first_.push_back(cut);
            end_.push_back(cut);
            open_.push_back(cell);
            before_.push_back(before);
          }
          is_open = true;
          ++end_.back();
        } else {
          const bool starts = wanted - before <= after - wanted;
          cuts_[static_cast<std::size_t>(cut)] = begin_of(starts ? cell : cell + 1, next);
          n_before_cuts_[static_cast<std::size_t>(cut)] = starts ? before : after;
        }
      }
      before = after;
    }
  }
  level_ = next;
  cut_level_ = next;
}

std::uint64_t CurveCut::n_tets_of(std::int32_t first, std::int32_t end) const {
  const auto before = [this](std::int32_t part) {
    if (part == 0) return std::uint64_t{0};
    return part == n_parts_ ? n_tets_ : n_before_cuts_[static_cast<std::size_t>(part) - 1];
  };
  return before(end) - before(first);
}

std::vector<std::int32_t> CurveCut::parts(std::span<const std::uint64_t> cells) const {
  const auto part_of = [this](std::uint64_t position) {
    return std::upper_bound(cuts_.begin(), cuts_.end(), position) - cuts_.begin();
  };
  std::vector<std::int32_t> parts(cells.size());
  if (n_parts_ == 1) return parts;
  // Most cells of the first levels lie in one part: a table for these, -1 for the others.
  std::vector<std::int32_t> part_of_cell(std::size_t{1} << 3 * table_levels);
  auto cut = cuts_.begin();
  for (std::uint64_t cell = 0; cell < part_of_cell.size(); ++cell) {
    while (cut != cuts_.end() && *cut <= begin_of(cell, table_levels)) ++cut;
    const bool whole = cut == cuts_.end() || *cut >= begin_of(cell + 1, table_levels);
    part_of_cell[cell] = whole ? static_cast<std::int32_t>(cut - cuts_.begin()) : -1;
  }
  Positions coarse(table_levels), fine(cut_level_);
  std::uint64_t last = 0;  // a position, and its part
  std::int32_t part_of_last = static_cast<std::int32_t>(part_of(0));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    parts[i] = part_of_cell[coarse.of(cells[i])];
    if (parts[i] >= 0) continue;
    const std::uint64_t position = begin_of(fine.of(cells[i]), cut_level_);
    if (position != last) {
      last = position;
      part_of_last = static_cast<std::int32_t>(part_of(position));
    }
    parts[i] = part_of_last;
  }
  return parts;
}

}  // namespace tess::m2m
