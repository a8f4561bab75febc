// One process, each PE a thread of it, PE 0 on the thread that calls run(). The default machine.
// Messages travel as pointers through the inbox of the PE; there is nobody to send bytes to.
#pragma once

#include "runtime/machine/machine.hpp"
#include "runtime/machine/team.hpp"

namespace tess {

/// `n_pes` threads, or, for 0, one for each core of the process's cpuset. PEs are tied to cores if
/// there is one for each. Throws Error for a negative number.
[[nodiscard]] std::unique_ptr<Machine> make_threads_machine(std::int32_t n_pes,
                                                            Pinning pinning = Pinning::automatic);

}  // namespace tess
