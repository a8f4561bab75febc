#include "m2m/partition_method.hpp"

#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"

namespace tess::m2m {

PartitionMethod parse_partition_method(const std::string& name) {
  if (name == "curve") return PartitionMethod::curve;
  if (name == "rcb") return PartitionMethod::rcb;
  if (name == "hsfc") return PartitionMethod::hsfc;
  fail(ErrorCode::bad_argument, "partition method '", name,
       "' is unknown; choose curve, rcb or hsfc", did_you_mean(name, "curve rcb hsfc"));
}

}  // namespace tess::m2m
