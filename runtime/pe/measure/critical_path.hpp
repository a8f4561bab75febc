// The critical path of a traced run: the chain of entry methods and messages that its end waited
// for. It is followed backwards from the slice of an entry method that ended last. What a slice
// waited for is the slice before it on its PE, if the PE was busy until then, and otherwise the
// send of its message:
//
//     PE 0   ▇▇▇▇▇▇▇▇ send ▇▇▇          ▇▇▇▇▇▇▇▇▇▇▇  the last end
//                       ╲              ╱
//     PE 1               ▇▇▇▇▇▇▇▇▇▇ send
//
// The path is the part of each slice up to the send (or the end), and the time between a cause and
// the slice that it led to. Both add up to the time from the first slice to the last.
#pragma once

#include "runtime/pe/measure/trace.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tess::detail {

struct CriticalPath {
  /// A part of the path: an entry method that ran, or the wait for it to begin.
  struct Link {
    std::uint32_t action = 0;
    PeId pe{};
    double begin = 0, seconds = 0;
    bool waits = false;
  };
  std::vector<Link> links;  ///< from the first to the last
  double running = 0;       ///< seconds in entry methods
  double waiting = 0;       ///< seconds between a cause and the beginning of what it led to
};

/// All PEs of a run, in order, with aligned clocks. Where records are missing the path begins.
[[nodiscard]] CriticalPath critical_path(const std::vector<TraceOfPe>& pes);

/// What the path consists of, by entry method and the runtime, and its longest links.
[[nodiscard]] std::string describe(const CriticalPath& path, std::size_t n_longest = 10);

}  // namespace tess::detail
