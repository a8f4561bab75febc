// A tree of boxes over numbered objects: the one tree of the spatial queries (queries.hpp) and of
// the surfaces of the distance/normal field (dn_field/bvh.hpp). Objects are split at the median of
// their centres along the widest axis, down to leaves of at most four. The order of the centres
// decides, and then the object's number, so equal centres do no harm.
//
//     objects of a leaf: places node.first … node.first + node.count; inner node: two children,
//     node.first and node.first + 1, which follow it in nodes()
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::collide {

/// `Box` is the caller's, and so are the boxes of the nodes: the caller sets them, from the last
/// node to the first. Immutable after that; queries may run on any thread.
template <class Box, std::size_t D>
class BoxTree {
 public:
  /// Floats are enough to split by, if they are relative to the box of all objects.
  struct Centre {
    std::array<float, D> at;
    std::uint32_t object;
  };
  struct Node {
    Box box{};
    std::uint32_t first = 0;  ///< leaf: first place; inner: first of two children
    std::uint32_t count = 0;  ///< leaf: number of places; inner: 0
  };

  BoxTree() = default;
  /// One centre per object, in any order. The boxes of the nodes are not set.
  explicit BoxTree(std::vector<Centre> centres);

  [[nodiscard]] std::span<Node> nodes() { return nodes_; }
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  /// The position of a node in nodes().
  [[nodiscard]] std::uint32_t number_of(const Node& node) const {
    return static_cast<std::uint32_t>(&node - nodes_.data());
  }
  /// Number of objects, and of places.
  [[nodiscard]] std::size_t size() const { return objects_.size(); }
  /// The object at a place.
  [[nodiscard]] std::uint32_t object(std::size_t place) const { return objects_[place]; }

  /// Calls visit(place) for the places of a leaf; an inner node has none.
  template <class Visit>
  static void each_place(const Node& leaf, const Visit& visit) {
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) visit(i);
  }
  /// Calls visit(number of a node) from the root down; it returns whether to visit the children.
  template <class Visit>
  void descend(const Visit& visit) const;

  /// Calls visit(leaf) for leaves with key(box) <= limit, those with small keys first. A visit may
  /// reduce the limit. The key of a box is not greater than that of a box inside. `from`: the node
  /// whose leaves are meant; the root is 0.
  template <class Key, class Visit>
  void descend_near(const Key& key, const double& limit, const Visit& visit,
                    std::uint32_t from = 0) const;

 private:
  static constexpr std::uint32_t leaf_size = 4;
  static constexpr std::size_t max_depth = 64;  // above log2 of the number of objects

  static std::size_t widest_axis(std::span<const Centre> centres);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> objects_;  // by place
};

template <class Box, std::size_t D>
std::size_t BoxTree<Box, D>::widest_axis(std::span<const Centre> centres) {
  std::array<float, D> low = centres[0].at, high = low;
  for (const Centre& c : centres)
    for (std::size_t a = 0; a < D; ++a) {
      low[a] = std::min(low[a], c.at[a]);
      high[a] = std::max(high[a], c.at[a]);
    }
  std::size_t widest = 0;
  for (std::size_t a = 1; a < D; ++a)
    if (high[a] - low[a] > high[widest] - low[widest]) widest = a;
  return widest;
}

template <class Box, std::size_t D>
BoxTree<Box, D>::BoxTree(std::vector<Centre> centres) {
  if (centres.empty()) return;
  struct Range {
    std::uint32_t node, first, last;
  };
  const auto n = static_cast<std::uint32_t>(centres.size());
  std::vector<Range> open{{0, 0, n}};
  nodes_.reserve(n);
  nodes_.emplace_back();
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    if (range.last - range.first <= leaf_size) {
      nodes_[range.node].first = range.first;
      nodes_[range.node].count = range.last - range.first;
      continue;
    }
    Centre* const begin = centres.data();
    const std::uint32_t middle = range.first + (range.last - range.first) / 2;
    const std::size_t axis = widest_axis({begin + range.first, begin + range.last});
    std::nth_element(begin + range.first, begin + middle, begin + range.last,
                     [axis](const Centre& a, const Centre& b) {
                       return a.at[axis] < b.at[axis] ||
                              (a.at[axis] == b.at[axis] && a.object < b.object);
                     });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[range.node].first = child;
    nodes_.emplace_back();
    nodes_.emplace_back();
    open.push_back({child + 1, middle, range.last});
    open.push_back({child, range.first, middle});
  }
  objects_.reserve(n);
  for (const Centre& c : centres) objects_.push_back(c.object);
}

template <class Box, std::size_t D>
template <class Visit>
void BoxTree<Box, D>::descend(const Visit& visit) const {
  if (nodes_.empty()) return;
  std::array<std::uint32_t, max_depth> stack;
  std::size_t height = 0;
  stack[height++] = 0;
  while (height > 0) {
    const std::uint32_t at = stack[--height];
    if (!visit(at) || nodes_[at].count != 0) continue;
    stack[height++] = nodes_[at].first;
    stack[height++] = nodes_[at].first + 1;
  }
}

template <class Box, std::size_t D>
template <class Key, class Visit>
void BoxTree<Box, D>::descend_near(const Key& key, const double& limit, const Visit& visit,
                                   std::uint32_t from) const {
  if (nodes_.empty()) return;
  struct Pending {
    std::uint32_t node;
    double key;
  };
  std::array<Pending, max_depth> stack;
  std::size_t height = 0;
  stack[height++] = {from, key(nodes_[from].box)};
  while (height > 0) {
    const Pending top = stack[--height];
    if (top.key > limit) continue;
    const Node& node = nodes_[top.node];
    if (node.count != 0) {
      visit(node);
      continue;
    }
    Pending near{node.first, key(nodes_[node.first].box)};
    Pending far{node.first + 1, key(nodes_[node.first + 1].box)};
    if (far.key < near.key) std::swap(near, far);
    if (far.key <= limit) stack[height++] = far;
    if (near.key <= limit) stack[height++] = near;
  }
}

}  // namespace tess::collide
