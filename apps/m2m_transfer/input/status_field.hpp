// The status of the target vertices as a field, for output.
#pragma once

#include "m2m/field.hpp"
#include "m2m/status.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace m2m_transfer {

/// "status": 0 inside, 1 boundary, 2 snapped, 3 outside. Its name begins with "transfer_" if one of
/// the fields that are written with it is a "status" too.
[[nodiscard]] inline tess::m2m::Field status_field(std::span<const tess::m2m::Status> status,
                                                   std::span<const tess::m2m::Field> others) {
  std::vector<double> values;
  for (const tess::m2m::Status s : status) values.push_back(static_cast<double>(s));
  std::string name = "status";
  while (std::ranges::find(others, name, &tess::m2m::Field::name) != others.end())
    name.insert(0, "transfer_");
  return {name, 1, std::move(values)};
}

}  // namespace m2m_transfer
