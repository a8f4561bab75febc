// The text of --explain: what a transfer uses, and what it leaves out.
#pragma once

#include "apps/m2m_transfer/input/problem.hpp"

#include <string>

namespace m2m_transfer {

/// The output besides the table: none, or the target mesh (--out).
enum class Output { report, mesh };

/// Returns several lines of text.
[[nodiscard]] std::string explain(const Problem& problem, Output output);

}  // namespace m2m_transfer
