#include "m2m/partition/curve_cut.hpp"

#include <algorithm>

namespace tess::m2m {
namespace {

constexpr int table_levels = 4;
constexpr int further_levels = 2;

/// The first position of a cell of `level`, at the last level.
std::uint64_t begin_of(std::uint64_t cell, int level) {
  return cell << static_cast<unsigned>(3 * (hilbert_levels - level));
}

}  // namespace

CurveCut::CurveCut(std::uint64_t n_tets, std::int32_t n_parts)
    : n_tets_(n_tets), n_parts_(n_parts), cuts_(static_cast<std::size_t>(n_parts) - 1) {
  if (n_parts == 1) return;
  first_ = {0};
  end_ = {n_parts - 1};
  open_ = {0};
  before_ = {0};
}

int CurveCut::next_level() const {
  // So fine that one round is enough for a mesh of even density, if its parts are not too many.
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

std::vector<std::uint32_t> CurveCut::counts(std::span<const std::uint64_t> cells) const {
  const int next = next_level();
  const unsigned bits = 3U * static_cast<unsigned>(next - level_);
  std::vector<std::uint32_t> counts(open_.size() << bits);
  for (const std::uint64_t cell : cells) {
    const std::uint64_t position = hilbert_position(cell, next);
    const std::uint64_t outer = position >> bits;
    const auto open = std::lower_bound(open_.begin(), open_.end(), outer);
    if (open == open_.end() || *open != outer) continue;
    const auto at = static_cast<std::uint64_t>(open - open_.begin());
    ++counts[at << bits | (position & ((std::uint64_t{1} << bits) - 1))];
  }
  return counts;
}

void CurveCut::refine(std::span<const std::uint32_t> counts) {
  const int next = next_level();
  const unsigned bits = 3U * static_cast<unsigned>(next - level_);
  const std::uint64_t enough = n_tets_ / static_cast<std::uint64_t>(n_parts_) / 32;
  const CurveCut last = *this;
  first_.clear();
  end_.clear();
  open_.clear();
  before_.clear();
  for (std::size_t k = 0; k < last.open_.size(); ++k) {
    const std::int32_t end = last.end_[k];
    std::int32_t cut = last.first_[k];
    std::uint64_t before = last.before_[k];
    for (std::uint64_t i = 0; i < std::uint64_t{1} << bits; ++i) {
      const std::uint64_t cell = last.open_[k] << bits | i;
      const std::uint64_t after = before + counts[k << bits | i];
      const bool opens = counts[k << bits | i] > enough && next < hilbert_levels;
      for (bool is_open = false; cut < end && target(cut) < after; ++cut) {
        const std::uint64_t wanted = target(cut);
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
        }
      }
      before = after;
    }
  }
  level_ = next;
  cut_level_ = next;
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
  for (std::size_t i = 0; i < cells.size(); ++i) {
    parts[i] = part_of_cell[hilbert_position(cells[i], table_levels)];
    if (parts[i] >= 0) continue;
    parts[i] = static_cast<std::int32_t>(
        part_of(begin_of(hilbert_position(cells[i], cut_level_), cut_level_)));
  }
  return parts;
}

}  // namespace tess::m2m
