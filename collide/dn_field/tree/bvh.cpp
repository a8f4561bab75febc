#include "collide/dn_field/bvh.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr double slack = 1 + 1e-9;  // so that rounding never prunes the nearest box

using Centre = collide::BoxTree<Bounds, 3>::Centre;

std::vector<Centre> centres(const Surface& surface) {
  const Bounds box = bounds(surface);
  const Vec3 size = box.size();
  const double scale = 1 / std::max({size.x, size.y, size.z});
  std::vector<Centre> all(surface.triangles.size());
  for (std::size_t t = 0; t < all.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    const Vec3 at = scale / 3 * ((a - box.low) + (b - box.low) + (c - box.low));
    all[t] = {{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)},
              static_cast<std::uint32_t>(t)};
  }
  return all;
}

}  // namespace

Bvh::Bvh(const Surface& surface) : tree_(centres(surface)) {
  prepared_.reserve(tree_.size());
  normals_.resize(tree_.size());
  for (std::size_t place = 0; place < tree_.size(); ++place) {
    const std::uint32_t triangle = tree_.object(place);
    prepared_.push_back(prepare(surface.corners(triangle)));
    normals_[triangle] = prepared_.back().normal;
  }
  summarise();
}

void Bvh::summarise() {
  const std::span<Node> nodes = tree_.nodes();
  moments_.resize(nodes.size());
  for (std::size_t at = nodes.size(); at-- > 0;) {
    Node& node = nodes[at];
    Moment& moment = moments_[at];
    Vec3 weighted;
    if (node.count == 0) {
      for (const std::size_t child : {node.first, node.first + 1}) {
        node.box.extend(nodes[child].box.low);
        node.box.extend(nodes[child].box.high);
        moment.area_normal += moments_[child].area_normal;
        moment.area += moments_[child].area;
        weighted += moments_[child].area * moments_[child].centre;
      }
    } else {
      Tree::each_place(node, [&](std::uint32_t i) {
        const PreparedTriangle& t = prepared_[i];
        for (const Vec3 p : t.corner) node.box.extend(p);
        const Vec3 area_normal = 0.5 * cross(t.edge[0], -t.edge[2]);
        const double area = norm(area_normal);
        moment.area_normal += area_normal;
        moment.area += area;
        weighted += area / 3 * (t.corner[0] + t.corner[1] + t.corner[2]);
      });
    }
    moment.centre = moment.area > 0 ? (1 / moment.area) * weighted : node.box.centre();
    const Vec3 reach = moment.centre - node.box.low, rest = node.box.high - moment.centre;
    moment.radius =
        norm({std::max(reach.x, rest.x), std::max(reach.y, rest.y), std::max(reach.z, rest.z)});
  }
}

namespace {

/// Calls visit(place) for the triangles that may be within sqrt(`bound`) of p; it may lower the
/// bound.
template <class Tree, class Visit>
void visit_near(const Tree& tree, Vec3 p, const double& bound, const Visit& visit) {
  tree.descend_near([&](const Bounds& box) { return box.distance2(p); }, bound,
                    [&](const typename Tree::Node& leaf) { Tree::each_place(leaf, visit); });
}

}  // namespace

ClosestPoint Bvh::closest(Vec3 p, double limit2) const {
  ClosestPoint best;
  double bound = limit2;
  visit_near(tree_, p, bound, [&](std::uint32_t i) {
    const Vec3 offset = offset_from(prepared_[i], p);
    const double distance2 = dot(offset, offset);
    if (distance2 > bound) return;
    bound = distance2;
    best = {distance2, p - offset, tree_.object(i)};
  });
  return best;
}

Vec3 Bvh::nearest_normal(Vec3 p, double limit2) const {
  Vec3 best;
  double bound = limit2;
  visit_near(tree_, p, bound, [&](std::uint32_t i) {
    const PreparedTriangle& triangle = prepared_[i];
    const double distance2 = dn::distance2(triangle, p.x, p.y, p.z);
    if (triangle.normal == Vec3{} || distance2 > bound) return;
    bound = distance2;
    best = triangle.normal;
  });
  return best;
}

namespace {

double furthest(const PointBlock& block) {
  double most = block.distance2[0];
  for (std::size_t l = 1; l < PointBlock::size; ++l)
    most = block.distance2[l] > most ? block.distance2[l] : most;
  return most;
}

constexpr std::size_t layer_size = 16;  // points of a block that are tested together

using Layers = std::array<bool, PointBlock::size / layer_size>;

/// Which layers of the block hold a point that is nearer to `box` than to its best triangle so far.
Layers nearer_layers(const PointBlock& block, const Bounds& box) {
  Layers layers{};
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    int nearer = 0;
    for (std::size_t l = layer * layer_size; l < (layer + 1) * layer_size; ++l) {
      const double ax = box.low.x - block.x[l], bx = block.x[l] - box.high.x;
      const double ay = box.low.y - block.y[l], by = block.y[l] - box.high.y;
      const double az = box.low.z - block.z[l], bz = block.z[l] - box.high.z;
      double dx = ax > bx ? ax : bx, dy = ay > by ? ay : by, dz = az > bz ? az : bz;
      dx = dx > 0 ? dx : 0;
      dy = dy > 0 ? dy : 0;
      dz = dz > 0 ? dz : 0;
      nearer |= dx * dx + dy * dy + dz * dz <= block.distance2[l] * slack ? 1 : 0;
    }
    layers[layer] = nearer != 0;
  }
  return layers;
}

void offer(PointBlock& block, const Layers& layers, const PreparedTriangle& candidate,
           std::uint64_t place) {
  const PreparedTriangle t = candidate;  // a copy that the block's stores cannot change
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    if (!layers[layer]) continue;
    for (std::size_t l = layer * layer_size; l < (layer + 1) * layer_size; ++l) {
      const double d = distance2(t, block.x[l], block.y[l], block.z[l]);
      const double known = block.distance2[l];
      const std::uint64_t holder = block.place[l];
      const bool wins = (d < known) | ((d == known) & (place < holder));
      block.distance2[l] = wins ? d : known;
      block.place[l] = wins ? place : holder;
    }
  }
}

}  // namespace

void Bvh::closest(PointBlock& block) const {
  Bounds box;
  for (std::size_t l = 0; l < PointBlock::size; ++l)
    if (block.distance2[l] >= 0) box.extend({block.x[l], block.y[l], block.z[l]});
  block.place.fill(PointBlock::none);
  double bound = furthest(block) * slack;
  tree_.descend_near([&](const Bounds& other) { return other.distance2(box); }, bound,
                     [&](const Node& leaf) {
                       const Layers layers = nearer_layers(block, leaf.box);
                       if (layers == Layers{}) return;
                       Tree::each_place(
                           leaf, [&](std::uint32_t i) { offer(block, layers, prepared_[i], i); });
                       bound = furthest(block) * slack;
                     });
}

bool Bvh::may_reach(const Bounds& box, double limit2) const {
  bool found = false;
  tree_.descend([&](std::uint32_t at) {
    const Node& node = tree_.nodes()[at];
    if (found || node.box.distance2(box) > limit2) return false;
    found = node.count != 0;
    return true;
  });
  return found;
}

}  // namespace tess::dn
