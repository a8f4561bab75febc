// Pairs on their way to the caller: they are collected in two arrays, and passed on when there are
// many.
#pragma once

#include "collide/pairs.hpp"
#include "collide/problem/scratch.hpp"
#include "runtime/core/simd.hpp"

namespace tess::collide::search {

class PairBuffer {
 public:
  explicit PairBuffer(detail::PairSink sink) : sink_(sink) {}
  /// Takes the memory of another one.
  PairBuffer(detail::PairSink sink, PairBuffer&& other)
      : sink_(sink), objects_(std::move(other.objects_)), partners_(std::move(other.partners_)) {}

  /// Makes room for a comparison with `n` boxes; passes the pairs on if they are many. The pairs
  /// that follow have the same order of sets.
  void prepare(std::size_t n, bool swapped) {
    if (n_ >= many || swapped != swapped_) flush();
    swapped_ = swapped;
    objects_.reserve(n_ + n + 16);
    partners_.reserve(n_ + n + 16);
  }
  /// Where the partners of the next object go; then added(object, their end).
  [[nodiscard]] std::uint32_t* next() noexcept { return partners_.data() + n_; }
  /// The boxes were compared `width` at a time.
  template <std::size_t width>
  void added(std::uint32_t object, const std::uint32_t* end) noexcept {
    const auto n = static_cast<std::size_t>(end - partners_.data());
    const auto objects = simd::all<simd::Vector<std::uint32_t, width>>(object);
    for (std::size_t i = n_; i < n; i += width) simd::store(objects_.data() + i, objects);
    n_ = n;
  }
  void flush() {
    if (n_ != 0) sink_.call(sink_.context, objects_.data(), partners_.data(), n_, swapped_);
    n_total_ += std::exchange(n_, 0);
  }
  [[nodiscard]] std::uint64_t n_total() const noexcept { return n_total_ + n_; }

 private:
  static constexpr std::size_t many = 2048;

  detail::PairSink sink_;
  Scratch<std::uint32_t> objects_, partners_;
  std::size_t n_ = 0;
  std::uint64_t n_total_ = 0;
  bool swapped_ = false;
};

}  // namespace tess::collide::search
