// One process in which each PE is a thread; PE 0 runs on the thread that calls run(). This is the
// default machine. Messages travel as pointers through the inbox of the PE.
#pragma once

#include "runtime/wire/machine/machine.hpp"
#include "runtime/wire/machine/team.hpp"

namespace tess::detail {

/// Makes a machine with `n_pes` threads, or for 0 with one per core of the process's cpuset. PEs
/// are pinned if there is a core for each. Throws Error for a negative number.
[[nodiscard]] std::unique_ptr<Machine> make_threads_machine(std::int32_t n_pes,
                                                            Pinning pinning = Pinning::automatic);

}  // namespace tess::detail

namespace tess {

using detail::make_threads_machine;

}  // namespace tess
