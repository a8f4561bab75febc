// Checks the header of a NetCDF-3 file (CDF-1, -2, -5) before libexodusII sees it: every list
// within the file, every variable's data within the file, every dimension known, and the arrays
// that the library reads without asking for their lengths shaped as it assumes. (NetCDF classic
// format specification, docs.unidata.ucar.edu.)
#pragma once

#include <string>
#include <string_view>

namespace tess::m2m {

/// Throws Error (bad_file) where the file is truncated or its header cannot be right.
void check_netcdf_header(const std::string& path, std::string_view bytes);

}  // namespace tess::m2m
