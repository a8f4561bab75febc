// Writes a NetCDF-3 file of fixed dimensions: first a header of all lists, then the variables in
// their order, in big-endian numbers. (NetCDF classic format specification, docs.unidata.ucar.edu.)
#pragma once

#include "m2m/io/new_file.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tess::m2m {

/// CDF-2 is read everywhere, and holds variables of less than 4 GiB.
enum class NetcdfVersion : std::uint8_t { cdf2 = 2, cdf5 = 5 };
enum class NetcdfType : std::uint8_t { int32 = 4, float64 = 6 };

struct NetcdfLayout {
  std::vector<std::pair<std::string, std::uint64_t>> dimensions{};
  std::vector<std::pair<std::string, std::string>> attributes{};
  struct Variable {
    std::string name;
    std::size_t dimension = 0;  ///< its only one, by position
    NetcdfType type{};
  };
  std::vector<Variable> variables{};
};

/// The header. The data follow it: every variable, padded to a multiple of four bytes.
[[nodiscard]] std::string netcdf_header(const NetcdfLayout& layout, NetcdfVersion version);

void write_big_endian(NewFile& file, std::span<const std::int32_t> numbers);
void write_big_endian(NewFile& file, std::span<const double> numbers);

}  // namespace tess::m2m
