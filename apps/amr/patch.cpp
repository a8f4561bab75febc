#include "apps/amr/patch.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <cmath>

namespace amr {
namespace {

constexpr double quanta = 0x1p60;
using Cell = std::array<std::int32_t, 3>;

std::size_t idx(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

Patch::Patch(const Problem& problem, BlockIndex index) : problem_(problem), index_(index) {
  const double h = problem_.spacing(index_.level());
  value_per_quantum_ = 1 / (quanta * h * h * h);
  masses_.resize(idx(n() * n() * n()));
}

std::array<double, 3> Patch::low() const {
  const Cell place = index_.coordinates();
  const double edge = 1.0 / (1 << index_.level());
  return {place[0] * edge, place[1] * edge, place[2] * edge};
}

Cell Patch::below(Face face, std::int32_t depth, std::int32_t column, std::int32_t row) const {
  Cell cell{};
  cell[idx(face / 2)] = (face & 1) != 0 ? n() - 1 - depth : depth;
  cell[idx((face / 2 + 1) % 3)] = column;
  cell[idx((face / 2 + 2) % 3)] = row;
  return cell;
}

void Patch::fill(double time) {
  const double h = problem_.spacing(index_.level());
  std::array<std::vector<double>, 3> means;
  for (std::int32_t axis = 0; axis < 3; ++axis)
    for (std::int32_t i = 0; i < n(); ++i)
      means[idx(axis)].push_back(problem_.mean(axis, low()[idx(axis)] + i * h, h, time));
  for (std::int32_t z = 0; z < n(); ++z)
    for (std::int32_t y = 0; y < n(); ++y)
      for (std::int32_t x = 0; x < n(); ++x)
        masses_[at({x, y, z})] = std::llrint(means[0][idx(x)] * means[1][idx(y)] *
                                             means[2][idx(z)] / value_per_quantum_);
}

Norms Patch::compare(double time) const {
  Patch exact(problem_, index_);
  exact.fill(time);
  Norms norms;
  const double volume = 1 / value_per_quantum_;
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    const double value = static_cast<double>(masses_[i]) * value_per_quantum_;
    const double error = value - static_cast<double>(exact.masses_[i]) * value_per_quantum_;
    norms.mass += masses_[i];
    norms.l1 += std::llrint(std::abs(error) * volume);
    norms.l2 += std::llrint(error * error * volume);
    norms.linf = std::max(norms.linf, std::abs(error));
    norms.largest = std::max(norms.largest, value);
    norms.least = std::min(norms.least, value);
  }
  norms.hash =
      tess::mix(index_.path ^ tess::hash_bytes(masses_.data(), masses_.size() * sizeof(Quanta)));
  return norms;
}

double Patch::steepness() const {
  Quanta most = 0;
  for (std::int32_t axis = 0; axis < 3; ++axis)
    for (std::int32_t row = 0; row < n(); ++row)
      for (std::int32_t column = 0; column < n(); ++column) {
        const Quanta* const first = &masses_[at(below(2 * axis, 0, column, row))];
        for (std::size_t i = 1; i < idx(n()); ++i)
          most = std::max(most, std::abs(first[i * stride(axis)] - first[(i - 1) * stride(axis)]));
      }
  return static_cast<double>(most) * value_per_quantum_;
}

std::vector<double> Patch::slice(double height, std::int32_t n_values) const {
  const auto cell = [&](double part) { return std::min(static_cast<int>(part * n()), n() - 1); };
  std::vector<double> values;
  for (std::int32_t y = 0; y < n_values; ++y)
    for (std::int32_t x = 0; x < n_values; ++x)
      values.push_back(
          value({cell((x + 0.5) / n_values), cell((y + 0.5) / n_values), cell(height)}));
  return values;
}

std::vector<double> Patch::layers(Face face) const {
  std::vector<double> values;
  values.reserve(idx(2 * n() * n()));
  for (std::int32_t layer = 0; layer < 2; ++layer)
    for (std::int32_t row = 0; row < n(); ++row)
      for (std::int32_t column = 0; column < n(); ++column)
        values.push_back(value(below(face, layer, column, row)));
  return values;
}

std::vector<double> Patch::coarse_layers(Face face) const {
  std::vector<double> values;
  for (std::int32_t layer = 0; layer < 4; layer += 2)
    for (std::int32_t row = 0; row < n(); row += 2)
      for (std::int32_t column = 0; column < n(); column += 2) {
        Quanta sum = 0;
        for (std::int32_t part = 0; part < n_octants; ++part)
          sum += masses_[at(
              below(face, layer + half(part, 0), column + half(part, 1), row + half(part, 2)))];
        values.push_back(static_cast<double>(sum) * value_per_quantum_ / 8);
      }
  return values;
}

double Patch::part_value(const Cell& cell, std::int32_t octant) const {
  const double here = value(cell);
  double result = here;
  for (std::int32_t axis = 0; axis < 3; ++axis) {
    Cell lower = cell, upper = cell;
    lower[idx(axis)] = std::max(cell[idx(axis)] - 1, 0);
    upper[idx(axis)] = std::min(cell[idx(axis)] + 1, n() - 1);
    const double slope = (value(upper) - value(lower)) / (upper[idx(axis)] - lower[idx(axis)]);
    result += (half(octant, axis) != 0 ? 0.25 : -0.25) * slope;
  }
  return result;
}

std::vector<double> Patch::fine_layers(Face face, std::int32_t quadrant) const {
  const std::int32_t axis = face / 2;
  const std::int32_t first_column = (quadrant & 1) * n() / 2, first_row = (quadrant >> 1) * n() / 2;
  std::vector<double> values;
  values.reserve(idx(2 * n() * n()));
  for (std::int32_t layer = 0; layer < 2; ++layer)
    for (std::int32_t row = 0; row < n(); ++row)
      for (std::int32_t column = 0; column < n(); ++column) {
        const std::int32_t near = layer == 0 ? face & 1 : 1 - (face & 1);
        const std::int32_t part =
            near << axis | (column & 1) << (axis + 1) % 3 | (row & 1) << (axis + 2) % 3;
        values.push_back(
            part_value(below(face, 0, first_column + column / 2, first_row + row / 2), part));
      }
  return values;
}

void Patch::set_halo(Face face, const std::vector<double>& values) {
  TESS_CHECK(values.size() == idx(2 * n() * n()), "a halo of ", 2 * n() * n(), " cells gets ",
             values.size());
  halo_[idx(face & 1)] = values;
}

void Patch::set_halo(Face face, std::int32_t quadrant, const std::vector<double>& values) {
  const std::int32_t m = n() / 2;
  TESS_CHECK(values.size() == idx(2 * m * m), "a quarter of a halo, ", 2 * m * m, " cells, gets ",
             values.size());
  std::vector<double>& halo = halo_[idx(face & 1)];
  halo.resize(idx(2 * n() * n()));
  for (std::int32_t layer = 0; layer < 2; ++layer)
    for (std::int32_t row = 0; row < m; ++row)
      for (std::int32_t column = 0; column < m; ++column)
        halo[idx((layer * n() + (quadrant >> 1) * m + row) * n() + (quadrant & 1) * m + column)] =
            values[idx((layer * m + row) * m + column)];
}

void Patch::compute_flows(std::int32_t axis) {
  const double v = problem_.velocity[idx(axis)];
  const double h = problem_.spacing(index_.level());
  const double c = std::abs(v) * problem_.dt / h;
  const double w = problem_.order == 3 ? (2 - c) / 3 : 0.5;
  const double share = problem_.order == 1 ? 0 : (1 - c) / 2;
  const double through = v * problem_.dt * h * h * quanta;  // of u = 1
  const std::size_t step = stride(axis);
  const std::int32_t m = n();
  flows_.resize(idx(m * m * (m + 1)));
  std::vector<double> u(idx(m + 4));  // two cells beyond each end
  for (std::int32_t row = 0; row < m; ++row)
    for (std::int32_t column = 0; column < m; ++column) {
      const Quanta* const first = &masses_[at(below(2 * axis, 0, column, row))];
      for (std::int32_t i = 0; i < m; ++i)
        u[idx(i + 2)] = static_cast<double>(first[idx(i) * step]) * value_per_quantum_;
      for (std::int32_t layer = 0; layer < 2; ++layer) {
        const std::size_t from = idx((layer * m + row) * m + column);
        u[idx(1 - layer)] = halo_[0][from];
        u[idx(m + 2 + layer)] = halo_[1][from];
      }
      for (std::int32_t face = 0; face <= m; ++face) {
        const double* const left = &u[idx(face + 1)];  // the cell left of the face
        const double across = left[1] - left[0];
        const double upwind = v >= 0
                                  ? left[0] + share * (w * across + (1 - w) * (left[0] - left[-1]))
                                  : left[1] - share * (w * across + (1 - w) * (left[2] - left[1]));
        flows_[idx((row * m + column) * (m + 1) + face)] = std::llrint(through * upwind);
      }
    }
}

std::vector<Quanta> Patch::coarse_flows(Face face) const {
  const std::int32_t m = n(), end = (face & 1) * m;
  std::vector<Quanta> sums;
  for (std::int32_t row = 0; row < m; row += 2)
    for (std::int32_t column = 0; column < m; column += 2) {
      Quanta sum = 0;
      for (std::int32_t part = 0; part < n_quadrants; ++part)
        sum += flows_[idx(((row + (part >> 1)) * m + column + (part & 1)) * (m + 1) + end)];
      sums.push_back(sum);
    }
  return sums;
}

void Patch::set_flows(Face face, std::int32_t quadrant, const std::vector<Quanta>& flows) {
  const std::int32_t m = n(), end = (face & 1) * m;
  for (std::int32_t row = 0; row < m / 2; ++row)
    for (std::int32_t column = 0; column < m / 2; ++column)
      flows_[idx((((quadrant >> 1) * m / 2 + row) * m + (quadrant & 1) * m / 2 + column) * (m + 1) +
                 end)] = flows[idx(row * m / 2 + column)];
}

void Patch::apply_flows(std::int32_t axis) {
  const std::int32_t m = n();
  const std::size_t step = stride(axis);
  for (std::int32_t row = 0; row < m; ++row)
    for (std::int32_t column = 0; column < m; ++column) {
      Quanta* const first = &masses_[at(below(2 * axis, 0, column, row))];
      const Quanta* const flow = &flows_[idx((row * m + column) * (m + 1))];
      for (std::int32_t i = 0; i < m; ++i) first[idx(i) * step] += flow[i] - flow[i + 1];
    }
}

std::vector<Quanta> Patch::refined(std::int32_t octant) const {
  const std::int32_t m = n();
  Patch child(problem_, index_.child(octant));
  const double volume = 1 / child.value_per_quantum_;
  for (std::int32_t z = 0; z < m / 2; ++z)
    for (std::int32_t y = 0; y < m / 2; ++y)
      for (std::int32_t x = 0; x < m / 2; ++x) {
        const Cell cell{half(octant, 0) * m / 2 + x, half(octant, 1) * m / 2 + y,
                        half(octant, 2) * m / 2 + z};
        Quanta rest = masses_[at(cell)];
        for (std::int32_t part = 0; part < n_octants; ++part) {
          const Quanta mass =
              part + 1 < n_octants ? std::llrint(part_value(cell, part) * volume) : rest;
          rest -= mass;
          child.masses_[at({2 * x + half(part, 0), 2 * y + half(part, 1), 2 * z + half(part, 2)})] =
              mass;
        }
      }
  return std::move(child.masses_);
}

std::vector<Quanta> Patch::coarsened() const {
  std::vector<Quanta> sums;
  for (std::int32_t z = 0; z < n(); z += 2)
    for (std::int32_t y = 0; y < n(); y += 2)
      for (std::int32_t x = 0; x < n(); x += 2) {
        Quanta sum = 0;
        for (std::int32_t part = 0; part < n_octants; ++part)
          sum += masses_[at({x + half(part, 0), y + half(part, 1), z + half(part, 2)})];
        sums.push_back(sum);
      }
  return sums;
}

void Patch::take(std::int32_t octant, const std::vector<Quanta>& masses) {
  const std::int32_t m = n() / 2;
  for (std::int32_t z = 0; z < m; ++z)
    for (std::int32_t y = 0; y < m; ++y)
      for (std::int32_t x = 0; x < m; ++x)
        masses_[at({half(octant, 0) * m + x, half(octant, 1) * m + y, half(octant, 2) * m + z})] =
            masses[idx((z * m + y) * m + x)];
}

}  // namespace amr
