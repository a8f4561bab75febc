// The measurements, one source file each. All run on PE 0, one after the other; each makes what it
// needs, repeats, checks what it did, and prints its rows.
#pragma once

#include "apps/bench/report.hpp"
#include "runtime/task.hpp"

#include <cstdint>

namespace bench {

struct Options {
  std::int32_t repeat = 5;
  std::int32_t elements = 1000;
};

/// How PE 0 and the last PE reach one another; the name in the rows and the reference figures.
enum class Reach { one_pe, one_process, processes };
[[nodiscard]] Reach reach();

/// One way of 8 bytes between an element on PE 0 and one on the last PE. Needs two PEs.
tess::Task ping_pong(const Report& report, Options options);
/// Messages to random elements of an array over all PEs: elapsed time over the number of messages.
tess::Task send_cost(const Report& report, Options options);
/// Creation on demand of 10⁶ elements of a sparse array: time and memory of each.
tess::Task creation(const Report& report, Options options);
/// A broadcast that every element answers by a contribution: time an element and round.
tess::Task collectives(const Report& report, Options options);
/// Elements with 1 KiB of state that go from PE to PE: elapsed time over migrations.
tess::Task migration(const Report& report, Options options);
tess::Task balance(const Report& report, Options options);

}  // namespace bench
