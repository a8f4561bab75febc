// Objects of very different sizes are searched on several levels. Level 0 has the objects up to some
// size, and each level those that are at most eight times as large as those of the level below, with
// voxels that fit them. All smaller objects visit those of its voxels that have objects. So each
// pair is found on the level of its larger object.
//
//     level l:  pairs within level l, and of level l with all levels below
#pragma once

#include "collide/problem/entry.hpp"
#include "collide/problem/survey.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tess::collide {

/// One of the levels: 0 is the finest.
using Level = std::int32_t;

namespace search {

/// The level of each size.
class SizeLevels {
 public:
  /// Level 0 has the sizes up to `most`, a positive number.
  explicit SizeLevels(double most) noexcept : most_(std::bit_cast<std::uint64_t>(most)) {}

  /// The bits of positive numbers have their order, and eight times a number has three times `octave`
  /// more.
  [[nodiscard]] Level of(double size) const noexcept {
    constexpr std::uint64_t octave = std::uint64_t{1} << 52;
    const auto bits = std::bit_cast<std::uint64_t>(size);
    return bits <= most_ ? 0 : static_cast<Level>(1 + (bits - most_ - 1) / (3 * octave));
  }
  /// The number of levels: infinity is on the last one.
  [[nodiscard]] Level n() const noexcept { return of(std::numeric_limits<double>::infinity()) + 1; }

 private:
  std::uint64_t most_;
};

/// Entries of objects in the order of their levels.
class ByLevel {
 public:
  template <class Real, std::size_t D>
  ByLevel(const Box<Real, D>* boxes, std::span<const Entry> entries, const SizeLevels& levels);

  [[nodiscard]] std::span<const Entry> of(std::size_t level) const noexcept {
    return std::span(entries_).subspan(begin_[level], begin_[level + 1] - begin_[level]);
  }
  /// Those of all levels below.
  [[nodiscard]] std::span<const Entry> below(std::size_t level) const noexcept {
    return std::span(entries_).first(begin_[level]);
  }

 private:
  std::vector<Entry> entries_;
  std::vector<std::size_t> begin_;
};

template <class Real, std::size_t D>
ByLevel::ByLevel(const Box<Real, D>* boxes, std::span<const Entry> entries,
                 const SizeLevels& levels)
    : entries_(entries.size()), begin_(static_cast<std::size_t>(levels.n()) + 1) {
  const auto level_of = [&](Entry entry) {
    return static_cast<std::size_t>(levels.of(longest_extent(boxes[object_of(entry)])));
  };
  for (const Entry entry : entries) ++begin_[level_of(entry) + 1];
  for (std::size_t l = 1; l < begin_.size(); ++l) begin_[l] += begin_[l - 1];
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (const Entry entry : entries) entries_[next[level_of(entry)]++] = entry;
}

}  // namespace search
}  // namespace tess::collide
