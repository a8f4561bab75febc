// The methods by which a mesh is cut into parts. All PEs compute `curve` together (place(),
// placement.hpp), or one process for a mesh that it holds; the library Zoltan computes the others
// on one process.
#pragma once

#include <string>

namespace tess::m2m {

enum class PartitionMethod {
  curve,  ///< equal pieces of a Hilbert curve, without Zoltan
  rcb,    ///< recursive coordinate bisection
  hsfc    ///< Hilbert space-filling curve of Zoltan
};

/// "curve", "rcb" or "hsfc". Throws Error (bad_argument) for any other name.
[[nodiscard]] PartitionMethod parse_partition_method(const std::string& name);

}  // namespace tess::m2m
