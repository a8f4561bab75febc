#include "apps/coupled/slab.hpp"

#include "apps/kit/charge.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

namespace coupled {
namespace {

// As measured.
constexpr std::chrono::nanoseconds per_node{15}, per_iteration{30};

}  // namespace

double exact(const Point& p, double time) {
  constexpr double pi = std::numbers::pi;
  return std::exp(-3 * pi * pi * time) * std::sin(pi * p[0]) * std::sin(pi * p[1]) *
         std::sin(pi * p[2]);
}

Slab::Slab(const Box& box) : box_(box) {
  const std::int32_t k = index().x;
  first_ = k * side() / box_.n_slabs;
  n_planes_ = (k + 1) * side() / box_.n_slabs - first_;
  n_given_planes_ = n_planes_ + (k + 1 < box_.n_slabs ? 1 : 0);
  points_.resize(static_cast<std::size_t>(n_given_planes_) * plane());
  place_points();
  cut_cubes();
  for (const Point& p : points_) values_.push_back(exact(p, 0));
  taken_.resize(2 * n_owned());
}

std::array<std::int32_t, 3> Slab::place(std::size_t node) const {
  const auto at = static_cast<std::int32_t>(node);
  return {first_ + at / (side() * side()), at / side() % side(), at % side()};
}

bool Slab::is_outermost(std::size_t node) const {
  const auto at = place(node);
  return std::any_of(at.begin(), at.end(), [&](std::int32_t x) { return x == 0 || x == box_.n; });
}

void Slab::place_points() {
  for (std::size_t node = 0; node < points_.size(); ++node) {
    const auto at = place(node);
    for (std::size_t axis = 0; axis < 3; ++axis)
      points_[node][axis] = box_.low[axis] + at[axis] * box_.spacing();
  }
}

void Slab::cut_cubes() {
  using tess::m2m::GlobalId;
  const GlobalId before = static_cast<GlobalId>(first_) * static_cast<GlobalId>(plane());
  for (std::size_t node = 0; node < points_.size(); ++node)
    point_ids_.push_back(before + static_cast<GlobalId>(node));
  // The ways from a corner of a cube to the opposite one along three edges.
  constexpr std::array<std::array<std::int32_t, 3>, 6> ways{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  const std::array<std::int32_t, 3> stride{side() * side(), side(), 1};
  for (std::int32_t x = 0; x + 1 < n_given_planes_; ++x)
    for (std::int32_t y = 0; y < box_.n; ++y)
      for (std::int32_t z = 0; z < box_.n; ++z)
        for (const auto& way : ways) {
          tess::m2m::Tet tet{(x * side() + y) * side() + z};
          for (std::size_t edge = 0; edge < 3; ++edge)
            tet[edge + 1] = tet[edge] + stride[static_cast<std::size_t>(way[edge])];
          tets_.push_back(tet);
          tet_ids_.push_back(6 * (before + tet[0]) + (&way - ways.data()));
        }
}

void Slab::exchange() {
  const auto plane_at = [&](std::int32_t x) {
    const auto begin = values_.begin() + static_cast<std::ptrdiff_t>(plane()) * x;
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(plane()));
  };
  const std::int32_t k = index().x;
  if (k > 0) array()[{k - 1}].send<&Slab::receive_plane>(false, plane_at(0));
  if (k + 1 < box_.n_slabs)
    array()[{k + 1}].send<&Slab::receive_plane>(true, plane_at(n_planes_ - 1));
}

void Slab::receive_plane(bool from_left, const std::vector<double>& values) {
  if (from_left) {
    left_ = values;
  } else {
    std::copy(values.begin(), values.end(), values_.end() - static_cast<std::ptrdiff_t>(plane()));
  }
}

void Slab::step(const Step& by) {
  diffuse(by);
  kit::charge(per_node, n_owned());
  if (box_.reaction.factor > 0) react(by);
}

void Slab::diffuse(const Step& by) {
  const double h = box_.spacing();
  const std::array<std::size_t, 3> stride{plane(), static_cast<std::size_t>(side()), 1};
  std::vector<double> next = values_;
  for (std::size_t node = 0; node < n_owned(); ++node) {
    if (is_outermost(node)) continue;
    double rate = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool is_left = axis == 0 && node < plane();
      const double before = is_left ? left_[node] : values_[node - stride[axis]];
      const double after = values_[node + stride[axis]];
      rate += (before - 2 * values_[node] + after) / (h * h) +
              by.velocity[axis] * (after - before) / (2 * h);
    }
    next[node] += by.dt * rate;
  }
  values_ = std::move(next);
}

void Slab::react(const Step& by) {
  std::uint64_t n_iterations = 0;
  for (std::size_t node = 0; node < n_owned(); ++node) {
    if (is_outermost(node) || values_[node] < Reaction::threshold) continue;
    Point p = points_[node];  // where the node will be
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] += by.dt * by.velocity[axis];
    values_[node] =
        box_.reaction.step(values_[node], exact(p, by.time + by.dt), by.dt, n_iterations);
  }
  kit::charge(per_iteration, n_iterations);
}

void Slab::move_to(Point low) {
  box_.low = low;
  place_points();
}

tess::m2m::MeshView Slab::mesh_view() const {
  return {points_, tets_, point_ids_, tet_ids_, static_cast<std::int64_t>(n_owned())};
}

std::span<const double> Slab::give() {
  given_.clear();
  for (std::size_t node = 0; node < points_.size(); ++node) {
    std::int32_t depth = box_.n;  // in cubes, to the nearest face of the box
    for (const std::int32_t x : place(node)) depth = std::min({depth, x, box_.n - x});
    given_.push_back(values_[node]);
    given_.push_back(depth * box_.spacing());
  }
  return given_;
}

void Slab::received(CouplingId coupling) {
  const auto status = this->status(coupling);
  for (std::size_t node = 0; node < n_owned(); ++node) {
    if (status[node] == tess::m2m::Status::outside) continue;
    if (box_.has_fringe ? !is_outermost(node) : taken_[2 * node + 1] < box_.least_depth) continue;
    values_[node] = taken_[2 * node];
    ++n_taken_;
  }
}

void Slab::compare(double time, tess::Callback<Comparison> result) {
  Comparison mine{0, 0, n_taken_};
  for (std::size_t node = 0; node < n_owned(); ++node) {
    kit::worsen(mine.error, std::abs(values_[node] - exact(points_[node], time)));
    const std::pair<tess::m2m::GlobalId, double> whole{point_ids_[node], values_[node]};
    mine.hash += tess::hash_bytes(&whole, sizeof whole);
  }
  contribute(JoinComparisons{}, mine, std::move(result));
}

}  // namespace coupled
