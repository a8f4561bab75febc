// Shrinks a failure and describes it.
#pragma once

#include "runtime/more/testing.hpp"
#include "runtime/more/testing/apart.hpp"
#include "runtime/more/testing/trial.hpp"

#include <cstdint>
#include <string>

namespace tess::test::detail {

/// Shrinks a failure, and describes it. If it needs several decisions, one of the next seeds before
/// `end` may show the same with fewer.
[[nodiscard]] std::string explain(const Program& program, std::uint64_t seed, std::uint64_t end,
                                  const Outcome& first, const SeedOptions& options);

/// Describes a failure. `facts` says how many decisions there are and where they come from.
[[nodiscard]] std::string report_of(const Repeat& repeat, const Outcome& outcome,
                                    const std::string& facts, const std::string& name);

/// Says on standard error if decisions of a repeat did not come up, so that it shows nothing.
void note_absent(const Repeat& repeat, const Outcome& outcome);

}  // namespace tess::test::detail
