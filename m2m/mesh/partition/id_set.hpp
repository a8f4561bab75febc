// A set of vertices between a least and a greatest one, as bits. The vertices that a part or a
// range of tetrahedra uses are found without sorting, and rank() numbers them in ascending order.
#pragma once

#include "m2m/mesh.hpp"

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

class IdSet {
 public:
  /// May hold the vertices from `least` to `greatest`.
  IdSet(VertexId least, VertexId greatest)
      : least_(least),
        words_((greatest < least ? 0 : static_cast<std::size_t>(greatest - least) / 64 + 1)) {}
  /// The corners of all tetrahedra.
  explicit IdSet(std::span<const Tet> tets) : IdSet(bounds_of(tets)) {
    for (const Tet& tet : tets)
      for (const VertexId v : tet) add(v);
    number();
  }

  void add(VertexId v) {
    const auto at = static_cast<std::size_t>(v - least_);
    words_[at / 64].bits |= std::uint64_t{1} << at % 64;
  }
  [[nodiscard]] bool has(VertexId v) const {
    const std::int64_t at = std::int64_t{v} - least_;
    if (at < 0 || at >= static_cast<std::int64_t>(words_.size() * 64)) return false;
    return (words_[static_cast<std::size_t>(at) / 64].bits >> static_cast<std::size_t>(at) % 64 &
            1U) != 0;
  }
  /// Call it after the last add() and before the functions below.
  void number() {
    n_ = 0;
    for (Word& word : words_) {
      word.before = n_;
      n_ += std::popcount(word.bits);
    }
  }
  [[nodiscard]] std::int32_t size() const { return n_; }
  /// How many vertices of the set are less than v, which is in the set.
  [[nodiscard]] std::int32_t rank(VertexId v) const {
    const auto at = static_cast<std::size_t>(v - least_);
    const Word& word = words_[at / 64];
    return word.before + std::popcount(word.bits & ((std::uint64_t{1} << at % 64) - 1));
  }
  /// All vertices, ascending.
  [[nodiscard]] std::vector<VertexId> list() const {
    std::vector<VertexId> ids;
    ids.reserve(static_cast<std::size_t>(n_));
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t bits = words_[w].bits; bits != 0; bits &= bits - 1)
        ids.push_back(least_ + static_cast<VertexId>(64 * w) + std::countr_zero(bits));
    return ids;
  }

 private:
  struct Word {
    std::uint64_t bits = 0;
    std::int32_t before = 0;
  };
  struct Bounds {
    VertexId least = 0, greatest = -1;
  };
  explicit IdSet(Bounds bounds) : IdSet(bounds.least, bounds.greatest) {}
  static Bounds bounds_of(std::span<const Tet> tets) {
    if (tets.empty()) return {};
    Bounds bounds{tets[0][0], tets[0][0]};
    for (const Tet& tet : tets)
      for (const VertexId v : tet) {
        bounds.least = v < bounds.least ? v : bounds.least;
        bounds.greatest = v > bounds.greatest ? v : bounds.greatest;
      }
    return bounds;
  }

  VertexId least_;
  std::int32_t n_ = 0;
  std::vector<Word> words_;
};

}  // namespace tess::m2m
