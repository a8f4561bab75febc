// Objects of very different sizes are searched on several levels. A level has the objects of a
// class, which are at most eight times as large as those of the class below, with voxels that fit
// them; all smaller objects visit those of its voxels that have objects. So each pair is found on
// the level of its larger object.
//
//     level c:  pairs within class c, and of class c with all smaller classes
#pragma once

#include "collide/search/entry.hpp"
#include "collide/search/survey.hpp"

#include <span>
#include <vector>

namespace tess::collide::search {

/// The class of each octave of sizes.
template <class Real>
class SizeClasses {
 public:
  /// Sizes up to `base` are class 0; each further class spans three octaves.
  explicit SizeClasses(Real base) : base_(octave_of(base)) {}

  [[nodiscard]] std::size_t of_octave(std::uint32_t octave) const noexcept {
    return octave < base_ + 1 ? 0 : 1 + (octave - base_ - 1) / 3;
  }
  [[nodiscard]] std::size_t size() const noexcept { return of_octave(n_octaves<Real> - 1) + 1; }

 private:
  std::uint32_t base_;
};

/// Entries of objects in the order of their classes.
class ByClass {
 public:
  template <class Real, std::size_t D>
  ByClass(const Box<Real, D>* boxes, std::span<const Entry> entries,
          const SizeClasses<Real>& classes);

  [[nodiscard]] std::span<const Entry> of(std::size_t c) const noexcept {
    return std::span(entries_).subspan(begin_[c], begin_[c + 1] - begin_[c]);
  }
  /// Of all smaller classes.
  [[nodiscard]] std::span<const Entry> below(std::size_t c) const noexcept {
    return std::span(entries_).first(begin_[c]);
  }

 private:
  std::vector<Entry> entries_;
  std::vector<std::size_t> begin_;
};

template <class Real, std::size_t D>
ByClass::ByClass(const Box<Real, D>* boxes, std::span<const Entry> entries,
                 const SizeClasses<Real>& classes)
    : entries_(entries.size()), begin_(classes.size() + 1) {
  const auto class_of = [&](Entry entry) {
    return classes.of_octave(octave_of(longest_extent(boxes[object_of(entry)])));
  };
  for (const Entry entry : entries) ++begin_[class_of(entry) + 1];
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (const Entry entry : entries) entries_[next[class_of(entry)]++] = entry;
}

}  // namespace tess::collide::search
