// An ExodusII file that a test writes with the library.
#pragma once

#include "tests/support/catch.hpp"

#include <exodusII.h>
#include <string>
#include <vector>

namespace tess::test {

/// Opens a new file of doubles; `mode` is 0 or EX_NETCDF4.
inline int new_exodus(const std::string& path, int mode = 0) {
  int compute = 8, stored = 8;
  const int id = ex_create(path.c_str(), EX_CLOBBER | mode, &compute, &stored);
  REQUIRE(id >= 0);
  return id;
}

/// Writes `n` elements of a type, all of whose vertices are in the list.
inline void put_block(int id, int number, const char* type, int n, const std::vector<int>& list) {
  ex_put_block(id, EX_ELEM_BLOCK, number, type, n, static_cast<int>(list.size()) / n, 0, 0, 0);
  ex_put_conn(id, EX_ELEM_BLOCK, number, list.data(), nullptr, nullptr);
}

}  // namespace tess::test
