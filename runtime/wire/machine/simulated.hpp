// A machine with any number of PEs, simulated in one thread as a sequential discrete-event
// simulation. Each PE has a virtual clock. Running a message advances it by the measured time or by
// a fixed cost (with which a run repeats bit for bit); a message arrives after latency + bytes /
// bandwidth. What is measured is the time of the program's code: neither that of the simulation nor
// that of the clock (work_clock.hpp). With a measured cost and without a seed a PE runs several
// messages in a step, as on real machines, so that messages to other processes are packed.
//
// With a seed the machine is adversarial: messages arrive in any order, some kinds of traffic are
// slow throughout, and a PE is asked to report its counters in the middle of its work. Every choice
// is drawn from the seed, so a failure repeats. A test may bring an adversary of its own.
#pragma once

#include "runtime/wire/machine/machine.hpp"
#include "runtime/wire/machine/simulated_options.hpp"

#include <memory>

namespace tess::detail {

[[nodiscard]] std::unique_ptr<Machine> make_simulated_machine(const SimulatedOptions& options);

}  // namespace tess::detail

namespace tess {

using detail::make_simulated_machine;

}  // namespace tess
