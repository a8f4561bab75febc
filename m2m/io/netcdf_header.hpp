// Checks the header of a NetCDF-3 file (CDF-1, -2, -5) before libexodusII reads it: every list and
// the data of every variable lie within the file, every dimension is known, and the arrays that the
// library reads without checking their lengths have the shape that it assumes. (NetCDF classic
// format specification, docs.unidata.ucar.edu.)
#pragma once

#include <string>
#include <string_view>

namespace tess::m2m {

/// Throws Error (bad_file) if the file is truncated or its header is inconsistent.
void check_netcdf_header(const std::string& path, std::string_view bytes);

}  // namespace tess::m2m
