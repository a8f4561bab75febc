// What a transfer uses and what it leaves out, for --explain.
#pragma once

#include "apps/m2m_transfer/problem.hpp"

#include <string>

namespace tess::m2m {

/// What is written besides the table: nothing, or the target mesh, too (--out).
enum class Output { report, mesh };

/// Lines for people.
[[nodiscard]] std::string explain(const Problem& problem, Output output);

}  // namespace tess::m2m
