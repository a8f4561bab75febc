// Energy drift against time step: the same stretch of time in steps of different length.
#pragma once

#include "apps/leanmd/report.hpp"

#include <vector>

namespace leanmd {

/// Runs steps of 2, 1, 1/2, 1/4, 1/8 times dt. An unstable row has an error.
tess::Task study(Options options, InitialState state, std::vector<Row>& rows);

}  // namespace leanmd
