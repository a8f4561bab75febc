// The methods by which a mesh is cut into parts. The library Zoltan computes the partition.
#pragma once

#include <string>

namespace tess::m2m {

enum class PartitionMethod {
  rcb,  ///< recursive coordinate bisection
  hsfc  ///< Hilbert space-filling curve
};

/// "rcb" or "hsfc". Throws Error (bad_argument) for any other name.
[[nodiscard]] PartitionMethod parse_partition_method(const std::string& name);

}  // namespace tess::m2m
