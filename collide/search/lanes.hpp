// The boxes of one voxel as arrays of coordinates, so that a box can be compared with many others
// at a time. The memory is kept from voxel to voxel.
//
// All pairs of up to some hundred boxes cost less than sorting them: 128 boxes take 4 vector
// comparisons a box.
#pragma once

#include "collide/box.hpp"
#include "collide/search/entry.hpp"
#include "collide/search/pair_buffer.hpp"
#include "collide/search/scratch.hpp"
#include "collide/search/wide.hpp"

#include <limits>

namespace tess::collide::search {

template <class Real, std::size_t D>
class Lanes {
 public:
  using Vector = Wide<Real>;
  static constexpr std::size_t width = Vector::width;

  /// Makes room for `n` boxes, followed by a vector of boxes that overlap nothing.
  void resize(std::size_t n) {
    if (n + width > stride_) {
      stride_ = (2 * n + 4 * width) / (2 * width) * (2 * width);
      coordinates_.resize(2 * D * stride_);
      numbers_.resize(3 * stride_);
      for (std::size_t k = 0; k < D; ++k) {
        lo_[k] = coordinates_.data() + k * stride_;
        hi_[k] = lo_[0] + (k + D) * stride_;
      }
      below_ = numbers_.data();
      model_ = below_ + stride_;
      object_ = model_ + stride_;
    }
    n_ = n;
    for (std::size_t i = n; i < n + width; ++i) {
      for (std::size_t k = 0; k < D; ++k) {
        lo_[k][i] = std::numeric_limits<Real>::infinity();
        hi_[k][i] = -std::numeric_limits<Real>::infinity();
      }
      below_[i] = model_[i] = object_[i] = 0;
    }
  }
  void set(std::size_t i, const Box<Real, D>& box, Entry entry, std::uint32_t model) noexcept {
    for (std::size_t k = 0; k < D; ++k) {
      lo_[k][i] = box.lo[k];
      hi_[k][i] = box.hi[k];
    }
    below_[i] = below_of(entry);
    object_[i] = object_of(entry);
    model_[i] = model;
  }
  [[nodiscard]] std::size_t size() const noexcept { return n_; }

  /// The box at a position, to be compared with others.
  struct Probe {
    Box<Real, D> box;
    std::uint32_t below, model, object;
  };
  [[nodiscard]] Probe probe(std::size_t i) const noexcept {
    Probe out{{}, below_[i], model_[i], object_[i]};
    for (std::size_t k = 0; k < D; ++k) {
      out.box.lo[k] = lo_[k][i];
      out.box.hi[k] = hi_[k][i];
    }
    return out;
  }

  /// Compares a box with the boxes from `begin` to `end`, and adds the pairs to `out`, without a
  /// branch per pair. A pair counts if the boxes overlap, if the voxel is responsible for it, and
  /// with `by_model` if the models differ.
  template <Touching touching, bool by_model>
  void compare(const Probe& probe, std::size_t begin, std::size_t end, PairBuffer& out) const {
    typename Vector::Register lo[D], hi[D];
    for (std::size_t k = 0; k < D; ++k) {
      lo[k] = Vector::all(probe.box.lo[k]);
      hi[k] = Vector::all(probe.box.hi[k]);
    }
    std::uint32_t* next = out.next();
    std::size_t j = begin / width * width;
    Mask among = all_lanes << (begin - j);
    for (; j < end; j += width, among = all_lanes) {
      Mask hits = among;
      for (std::size_t k = 0; k < D; ++k) {
        const auto other_lo = Vector::load(lo_[k] + j), other_hi = Vector::load(hi_[k] + j);
        if constexpr (touching == Touching::counts) {
          hits = Vector::template less<true>(hits, Vector::greater(lo[k], other_lo),
                                             Vector::lesser(hi[k], other_hi));
        } else {
          hits = Vector::template less<false>(hits, other_lo, hi[k]);
          hits = Vector::template less<false>(hits, lo[k], other_hi);
        }
      }
      hits = Vector::disjoint(hits, below_ + j, probe.below);
      if constexpr (by_model) hits = Vector::differ(hits, model_ + j, probe.model);
      if (end - j < width) hits &= (Mask{1} << (end - j)) - 1;
      next = Vector::compress(next, hits, object_ + j);
    }
    out.template added<Vector>(probe.object, next);
  }

 private:
  static constexpr Mask all_lanes = static_cast<Mask>((std::uint64_t{1} << width) - 1);

  std::array<Real*, D> lo_{}, hi_{};
  std::uint32_t *below_ = nullptr, *model_ = nullptr, *object_ = nullptr;
  Scratch<Real> coordinates_;
  Scratch<std::uint32_t> numbers_;
  std::size_t n_ = 0, stride_ = 0;
};

}  // namespace tess::collide::search
