// A measurement in a process of its own: it finds no memory that another one has freed, cut into
// small blocks or given back. (After six runs on one PE, 256 PEs took seven times as long.)
#pragma once

#include "apps/m2m_scaling/report.hpp"

#include <functional>

namespace m2m_scaling {

/// Calls run(row) in a child process, which ends with the exit code that it returns. Returns this
/// code, and the row as the child left it. What `run` prints appears as usual; `program` is the name
/// in front of its errors.
[[nodiscard]] int in_own_process(const char* program, const std::function<int(Row&)>& run,
                                 Row& row);

}  // namespace m2m_scaling
