// An ExodusII file that a test writes with the library.
#pragma once

#include "tests/support/catch.hpp"

#include <exodusII.h>
#include <string>

namespace tess::test {

/// Opens a new file of doubles; `mode` is 0 or EX_NETCDF4.
inline int new_exodus(const std::string& path, int mode = 0) {
  int compute = 8, stored = 8;
  const int id = ex_create(path.c_str(), EX_CLOBBER | mode, &compute, &stored);
  REQUIRE(id >= 0);
  return id;
}

}  // namespace tess::test
