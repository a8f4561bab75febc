// The name of a coupling (coupling.hpp), for what keeps something per coupling.
#pragma once

#include <cstdint>

namespace tess::m2m {

/// A coupling; unique within the run.
enum class CouplingId : std::uint64_t {};

}  // namespace tess::m2m
