// The boxes of one voxel as arrays of coordinates, so that a box can be compared with many others
// at a time. The memory is kept from voxel to voxel.
//
// All pairs of up to some hundred boxes cost less than sorting them: 128 boxes take 4 vector
// comparisons a box. Vectors only compare numbers, so every instruction set gives the same bits (a
// test compares them with loops).
#pragma once

#include "collide/box.hpp"
#include "collide/problem/entry.hpp"
#include "collide/problem/scratch.hpp"
#include "collide/search/pair_buffer.hpp"
#include "runtime/core/algorithm.hpp"
#include "runtime/core/simd.hpp"

#include <limits>

namespace tess::collide::search {

template <class Real, std::size_t D>
class Lanes {
  using Register = simd::Vector<Real, simd::widest / sizeof(Real)>;
  using Numbers = simd::Vector<std::uint32_t, simd::widest / sizeof(Real)>;

 public:
  static constexpr std::size_t width = simd::widest / sizeof(Real);

  /// Makes room for `n` boxes, followed by a vector of boxes that overlap nothing.
  void resize(std::size_t n) {
    if (n + width > stride_) {
      stride_ = (2 * n + 4 * width) / (2 * width) * (2 * width);
      coordinates_.resize(2 * D * stride_);
      numbers_.resize(2 * stride_);
      for (std::size_t k = 0; k < D; ++k) {
        lo_[k] = coordinates_.data() + k * stride_;
        hi_[k] = lo_[0] + (k + D) * stride_;
      }
      entry_ = numbers_.data();
      model_ = entry_ + stride_;
    }
    n_ = n;
    for (std::size_t i = n; i < n + width; ++i) {
      for (std::size_t k = 0; k < D; ++k) {
        lo_[k][i] = std::numeric_limits<Real>::infinity();
        hi_[k][i] = -std::numeric_limits<Real>::infinity();
      }
      entry_[i] = model_[i] = 0;
    }
  }
  void set(std::size_t i, const Box<Real, D>& box, Entry entry) noexcept {
    for (std::size_t k = 0; k < D; ++k) {
      lo_[k][i] = box.lo[k];
      hi_[k][i] = box.hi[k];
    }
    entry_[i] = static_cast<std::uint32_t>(entry);
  }
  void set_model(std::size_t i, std::uint32_t model) noexcept { model_[i] = model; }
  [[nodiscard]] std::size_t size() const noexcept { return n_; }

  /// The box at a position, to be compared with others.
  struct Probe {
    Register lo[D], hi[D];
    Entry entry;
    std::uint32_t model;
  };
  [[nodiscard, gnu::always_inline]] Probe probe(std::size_t i) const noexcept {
    Probe out{{}, {}, static_cast<Entry>(entry_[i]), model_[i]};
    for (std::size_t k = 0; k < D; ++k) {
      out.lo[k] = simd::all<Register>(lo_[k][i]);
      out.hi[k] = simd::all<Register>(hi_[k][i]);
    }
    return out;
  }
  [[nodiscard, gnu::always_inline]] static Probe probe(const Box<Real, D>& box, Entry entry,
                                                       std::uint32_t model) noexcept {
    Probe out{{}, {}, entry, model};
    for (std::size_t k = 0; k < D; ++k) {
      out.lo[k] = simd::all<Register>(box.lo[k]);
      out.hi[k] = simd::all<Register>(box.hi[k]);
    }
    return out;
  }
  [[nodiscard]] const Real* upper_ends(std::size_t axis) const noexcept { return hi_[axis]; }
  /// The greatest upper end of the `width` boxes from a position on.
  [[nodiscard]] Real highest(std::size_t begin, std::size_t axis) const noexcept {
    Real out = hi_[axis][begin];
    for (std::size_t i = 1; i < width; ++i) out = std::max(out, hi_[axis][begin + i]);
    return out;
  }

  /// Compares a box with the boxes from `begin` to at least `end` (the last vector is completed),
  /// and adds the pairs to `out`, without a branch per pair. A pair counts if the boxes overlap, if
  /// the voxel is responsible for it, and with `by_model` if the models differ.
  template <Touching touching, bool by_model>
  [[gnu::always_inline]] void compare(const Probe& probe, std::size_t begin, std::size_t end,
                                      PairBuffer& out) const {
    std::uint32_t* next = out.next();
    std::size_t j = begin / width * width;
    simd::Bits among = all_lanes << (begin - j);
    for (; j < end; j += width, among = all_lanes) {
      simd::Bits hits = among;
      for (std::size_t k = 0; k < D; ++k) {
        const auto other_lo = simd::load<Register>(lo_[k] + j),
                   other_hi = simd::load<Register>(hi_[k] + j);
        if constexpr (touching == Touching::counts) {
          hits = simd::less<true>(hits, simd::max(probe.lo[k], other_lo),
                                  simd::min(probe.hi[k], other_hi));
        } else {
          hits = simd::less<false>(hits, other_lo, probe.hi[k]);
          hits = simd::less<false>(hits, probe.lo[k], other_hi);
        }
      }
      const auto entries = simd::load<Numbers>(entry_ + j);
      hits = simd::disjoint(hits, entries, simd::all<Numbers>(below_of(probe.entry)));
      if constexpr (by_model)
        hits = simd::differ(hits, simd::load<Numbers>(model_ + j), simd::all<Numbers>(probe.model));
      next = simd::compress(next, hits, entries >> 4);
    }
    out.template added<width>(object_of(probe.entry), next);
  }

 private:
  static constexpr simd::Bits all_lanes = static_cast<simd::Bits>((std::uint64_t{1} << width) - 1);

  std::array<Real*, D> lo_{}, hi_{};
  std::uint32_t *entry_ = nullptr, *model_ = nullptr;
  Scratch<Real> coordinates_;
  Scratch<std::uint32_t> numbers_;
  std::size_t n_ = 0, stride_ = 0;
};

}  // namespace tess::collide::search
