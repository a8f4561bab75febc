// What the program prints and writes about one simulation.
#pragma once

#include "apps/kit/output/json.hpp"
#include "apps/leanmd/simulation.hpp"

#include <string>

namespace leanmd {

/// What this run does, step by step.
[[nodiscard]] std::string explain(const Options& options, std::int64_t n_atoms);
[[nodiscard]] std::string table(const Options& options, const Outcome& outcome);
[[nodiscard]] kit::Json json_of(const Options& options, const Outcome& outcome);

}  // namespace leanmd
