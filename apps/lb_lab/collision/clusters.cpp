#include "apps/lb_lab/collision/clusters.hpp"

#include "apps/lb_lab/run/kind.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lb_lab {
namespace {

constexpr std::uint64_t n_clusters = 8;
constexpr double nominal_object_seconds = 0.45e-6;  // measured
constexpr double mean_partners = 8;                 // of an object, in a cluster of mean size
// Measured; most objects are in denser clusters than the mean one, and clusters meet.
constexpr double pairs_an_object = 9.5;

/// Back and forth between 0 and 1, with period 2.
double to_and_fro(double x) {
  return std::abs(x - 2 * std::floor(x / 2 + 0.5));
}

}  // namespace

Clusters::Clusters(const Problem& p)
    : width_(p.domain.width),
      height_(p.domain.height),
      n_iterations_(p.n_iterations),
      seed_(p.seed),
      n_objects_(n_items(p, nominal_object_seconds)),
      seconds_a_pair_(item_seconds(p, n_objects_) / pairs_an_object),
      radius_(0.15 * std::min(width_, height_)) {
  // Boxes of one edge meet where their centres differ by less on each axis: of the objects in a
  // disc of depth 1 an object meets a share of about (2 edge)^3 / volume.
  const double volume = std::numbers::pi * radius_ * radius_;
  const double mean_size = static_cast<double>(n_objects_) / n_clusters;
  edge_ = 0.5 * std::cbrt(mean_partners * volume / mean_size);
}

std::uint64_t Clusters::first_of(std::uint64_t cluster) const {
  const auto squares = [](std::uint64_t n) { return n * (n + 1) * (2 * n + 1) / 6; };
  return n_objects_ * squares(cluster) / squares(n_clusters);
}

Clusters::Pose Clusters::pose(std::uint64_t cluster, std::int32_t iteration) const {
  const std::uint64_t hash = tess::mix(seed_ + 64 * (cluster + 1));
  const double time = iteration / n_iterations_;  // of the run
  const double margin = radius_ + edge_;
  const auto drift = [&](double extent, std::uint64_t which) {
    const double speed = 0.5 + drawn(hash + which);
    return margin + (extent - 2 * margin) * to_and_fro(2 * drawn(hash + which + 1) + speed * time);
  };
  const double angle = 2 * std::numbers::pi * (drawn(hash + 4) - 0.5) * time;
  return {drift(width_, 0), drift(height_, 2), std::cos(angle), std::sin(angle)};
}

std::vector<tess::collide::Item> Clusters::items(std::uint64_t first, std::uint64_t last,
                                                 tess::collide::OwnerId owner,
                                                 std::int32_t iteration) const {
  std::vector<tess::collide::Item> result;
  result.reserve(last - first);
  for (std::uint64_t cluster = 0; cluster < n_clusters; ++cluster) {
    const Pose at = pose(cluster, iteration);
    const std::uint64_t end = std::min(last, first_of(cluster + 1));
    for (std::uint64_t i = std::max(first, first_of(cluster)); i < end; ++i) {
      const std::uint64_t hash = tess::mix(seed_ ^ tess::mix(i));
      const double r = radius_ * std::sqrt(drawn(hash)),
                   phi = 2 * std::numbers::pi * drawn(hash + 1);
      const double dx = r * std::cos(phi), dy = r * std::sin(phi);
      const tess::collide::Point low{at.x + dx * at.cosine - dy * at.sine,
                                     at.y + dx * at.sine + dy * at.cosine,
                                     (1 - edge_) * drawn(hash + 2)};
      const auto number = static_cast<std::uint32_t>(i);
      result.push_back({{low, {low[0] + edge_, low[1] + edge_, low[2] + edge_}},
                        {owner, tess::collide::LocalId{number}, tess::collide::ModelId{0}}});
    }
  }
  return result;
}

std::uint64_t answer_of_pair(tess::collide::LocalId a, tess::collide::LocalId b,
                             std::int32_t iteration) {
  const auto low = static_cast<std::uint64_t>(std::min(a, b));
  const auto high = static_cast<std::uint64_t>(std::max(a, b));
  return tess::mix((low << 32U | high) ^ tess::mix(static_cast<std::uint64_t>(iteration)));
}

}  // namespace lb_lab
