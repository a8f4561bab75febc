// How much memory a piece of work takes at its peak.
#pragma once

#include <cstddef>
#include <functional>

namespace bench {

/// By how many bytes the resident memory grows at most while `run` runs: in a forked process, so
/// that nothing which an earlier run kept is used again. Call it before a library has started
/// threads, which a fork loses.
[[nodiscard]] std::size_t peak_bytes(const std::function<void()>& run);

}  // namespace bench
