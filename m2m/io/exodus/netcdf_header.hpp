// Reads and checks the header of a NetCDF-3 file (CDF-1, -2, -5): every list and the data of every
// variable lie within the file, every dimension is known, and the arrays that libexodusII reads
// without checking their lengths have the shape that it assumes. (NetCDF classic format
// specification, docs.unidata.ucar.edu.)
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tess::m2m {

struct NetcdfDimension {
  std::string name;
  std::uint64_t length;  ///< 0: the record dimension
};
struct NetcdfVariable {
  std::string name;
  std::vector<std::size_t> shape;  ///< positions in the list of dimensions
  std::uint64_t type = 0;          ///< 4: int32, 5: float, 6: double, 10: int64
  std::uint64_t begin = 0;         ///< byte in the file; numbers are big-endian
};
struct NetcdfHeader {
  std::vector<NetcdfDimension> dimensions{};
  std::vector<NetcdfVariable> variables{};
  std::uint64_t n_records = 0;
};

/// Throws Error (bad_file) if the file is truncated or its header is inconsistent.
[[nodiscard]] NetcdfHeader read_netcdf_header(const std::string& path, std::string_view bytes);
inline void check_netcdf_header(const std::string& path, std::string_view bytes) {
  (void)read_netcdf_header(path, bytes);
}

}  // namespace tess::m2m
