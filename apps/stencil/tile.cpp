#include "apps/stencil/tile.hpp"

#include "apps/kit/worst.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace stencil {

Outcome Combine::operator()(const Outcome& a, const Outcome& b) const {
  Outcome both{a.from_iterate, a.from_solution, a.hash + b.hash};
  kit::worsen(both.from_iterate, b.from_iterate);
  kit::worsen(both.from_solution, b.from_solution);
  return both;
}

Tile::Tile(const Problem& problem, std::int32_t x, std::int32_t y, std::int32_t width,
           std::int32_t height)
    : problem_(problem), x_(x), y_(y), width_(width), height_(height) {
  values_.resize(at(width, height) + 1);
  source_.resize(values_.size());
  const double h = problem.spacing();
  const double scale = h * h * std::numbers::pi * std::numbers::pi / 2;
  for (std::int32_t row = 0; row < height; ++row)
    for (std::int32_t column = 0; column < width; ++column)
      source_[at(column, row)] = scale * problem.solution(x + column, y + row);
}

Tile::Line Tile::line(Side side, bool halo) const {
  const std::int32_t out = halo ? 1 : 0;
  const auto stride = static_cast<std::size_t>(width_ + 2);
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  switch (side) {
    case Side::west:
      return {at(-out, 0), stride, height};
    case Side::east:
      return {at(width_ - 1 + out, 0), stride, height};
    case Side::south:
      return {at(0, -out), 1, width};
    case Side::north:
      break;
  }
  return {at(0, height_ - 1 + out), 1, width};
}

std::vector<double> Tile::edge(Side side) const {
  const Line along = line(side, false);
  std::vector<double> values(along.n);
  for (std::size_t i = 0; i < along.n; ++i) values[i] = values_[along.first + i * along.stride];
  return values;
}

void Tile::set_halo(Side side, const std::vector<double>& values) {
  const Line along = line(side, true);
  TESS_CHECK(values.size() == along.n, "a halo of ", along.n, " points gets ", values.size());
  for (std::size_t i = 0; i < along.n; ++i) values_[along.first + i * along.stride] = values[i];
}

double Tile::jacobi() {
  next_.resize(values_.size());
  const auto stride = static_cast<std::size_t>(width_ + 2);
  // One maximum per lane: a single maximum would be a chain of dependences from point to point.
  constexpr std::int32_t n_lanes = 8;
  std::array<double, n_lanes> change{};
  for (std::int32_t row = 0; row < height_; ++row) {
    const double* const here = values_.data() + at(0, row);
    const double* const below = here - stride;
    const double* const above = here + stride;
    const double* const source = source_.data() + at(0, row);
    double* const next = next_.data() + at(0, row);
    for (std::int32_t i = 0; i < width_; ++i)
      next[i] = 0.25 * (here[i - 1] + here[i + 1] + below[i] + above[i]) + source[i];
    for (std::int32_t i = 0; i < width_; i += n_lanes) {
      const std::int32_t n = std::min(n_lanes, width_ - i);
      for (std::int32_t lane = 0; lane < n; ++lane) {
        const double difference = std::abs(next[i + lane] - here[i + lane]);
        double& most = change[static_cast<std::size_t>(lane)];
        most = most < difference ? difference : most;
      }
    }
  }
  std::swap(values_, next_);
  return *std::max_element(change.begin(), change.end());
}

Outcome Tile::compare(std::int32_t steps) const {
  Outcome outcome;
  const double amplitude = problem_.amplitude(steps);
  for (std::int32_t row = 0; row < height_; ++row) {
    for (std::int32_t column = 0; column < width_; ++column) {
      const double value = values_[at(column, row)];
      const double solution = problem_.solution(x_ + column, y_ + row);
      kit::worsen(outcome.from_iterate, std::abs(value - amplitude * solution));
      kit::worsen(outcome.from_solution, std::abs(value - solution));
      const auto point =
          static_cast<std::uint64_t>(y_ + row) << 32U | static_cast<std::uint64_t>(x_ + column);
      outcome.hash += tess::mix(tess::mix(point) ^ std::bit_cast<std::uint64_t>(value));
    }
  }
  return outcome;
}

Tile::Sampled Tile::sampled(std::int32_t stride) const {
  const auto next = [stride](std::int32_t from) { return (from + stride - 1) / stride * stride; };
  Sampled out{next(x_) / stride, next(y_) / stride, 0, {}};
  for (std::int32_t y = next(y_); y < y_ + height_; y += stride) {
    out.columns = 0;
    for (std::int32_t x = next(x_); x < x_ + width_; x += stride, ++out.columns)
      out.values.push_back(values_[at(x - x_, y - y_)]);
  }
  return out;
}

}  // namespace stencil
