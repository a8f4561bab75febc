// Fields of awkward numbers for tests of files, and their comparison bit for bit.
#pragma once

#include "m2m/field.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace tess::test {

/// Random values of all magnitudes, between them NaN, infinity, -0, and the least positive number.
inline m2m::Field awkward_field(const std::string& name, std::size_t n_rows,
                                std::size_t n_components, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  m2m::Field field{name, n_components, std::vector<double>(n_rows * n_components)};
  constexpr double special[] = {std::numeric_limits<double>::quiet_NaN(),
                                -std::numeric_limits<double>::infinity(), -0.0, 5e-324};
  for (double& value : field.values) {
    value = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 200) - 100);
    if (random() % 8 == 0) value = special[random() % 4];
  }
  return field;
}

inline std::vector<std::uint64_t> bits_of(const std::vector<double>& values) {
  std::vector<std::uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

}  // namespace tess::test
