// The status of the target vertices as a field, for output.
#pragma once

#include "m2m/field.hpp"
#include "m2m/status.hpp"

#include <span>
#include <utility>
#include <vector>

namespace m2m_transfer {

/// "status": 0 inside, 1 boundary, 2 snapped, 3 outside.
[[nodiscard]] inline tess::m2m::Field status_field(std::span<const tess::m2m::Status> status) {
  std::vector<double> values;
  for (const tess::m2m::Status s : status) values.push_back(static_cast<double>(s));
  return {"status", 1, std::move(values)};
}

}  // namespace m2m_transfer
