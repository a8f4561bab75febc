// One way to find all pairs of boxes: ours, another library's, or brute force.
#pragma once

#include "apps/bench/collide/case.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace bench {

/// Two positions in the input, the smaller in the upper half: pairs sort by the first, then the
/// second.
using PackedPair = std::uint64_t;
[[nodiscard]] inline PackedPair packed(std::uint32_t a, std::uint32_t b) {
  return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
}

class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  virtual ~Method() = default;

  /// Builds whatever the method needs from the boxes, and visits every pair once to count it. This
  /// is what is timed.
  virtual std::uint64_t count() = 0;
  /// The same pairs in any order.
  virtual std::vector<PackedPair> pairs() = 0;
  /// The pairs that a library passes to its caller, which tests them; the pairs, if it tests them
  /// itself.
  virtual std::vector<PackedPair> candidates() { return pairs(); }
};

/// Whose method it is decides what its pairs are compared with.
enum class Whose { ours, peer, brute_force };

struct MethodKind {
  std::string_view name;
  std::string_view meaning;
  Whose whose;
  /// Null if the build did not find the library, or if it cannot do this problem. What it prepares
  /// here is not timed: its own form of the input. `problem` must outlive the method.
  std::unique_ptr<Method> (*make)(const Problem& problem);
};
[[nodiscard]] std::span<const MethodKind> method_kinds();

[[nodiscard]] std::unique_ptr<Method> our_doubles(const Problem& problem);
/// On Problem::floats or float_triangles; its pairs are those of the rounded objects.
[[nodiscard]] std::unique_ptr<Method> our_floats(const Problem& problem);
/// Boxes as user geometry, doubles rounded outward to floats; closed boxes only. Embree passes on
/// all pairs of two leaves, so the callback tests the boxes of doubles.
[[nodiscard]] std::unique_ptr<Method> embree_pairs(const Problem& problem);
/// The box that Embree is given.
[[nodiscard]] FloatBox rounded_outward(const Aabb& box);
/// DynamicAABBTreeCollisionManager<double>; its collision objects are prepared. Closed boxes only.
[[nodiscard]] std::unique_ptr<Method> fcl_pairs(const Problem& problem);
/// The same with FCL's own boxes, which are given by centre and sides: that rounds their corners.
[[nodiscard]] std::unique_ptr<Method> fcl_centred_pairs(const Problem& problem);
/// Null beyond 8 192 objects.
[[nodiscard]] std::unique_ptr<Method> brute_force(const Problem& problem);

}  // namespace bench
