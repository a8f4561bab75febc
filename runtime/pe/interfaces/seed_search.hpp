// What --sim seeds=FIRST..LAST does. Tessera::testing sets it before main(); null in a program without.
#pragma once

#include "runtime/pe/interfaces/runtime_options.hpp"
#include "runtime/wire/machine/simulated_options.hpp"

#include <functional>

namespace tess::detail {

/// Runs a program once per seed, in child processes, and compares what it prints. `program` runs it
/// in the calling process, and returns its exit code; so does the search.
extern int (*search_seeds)(const SeedRange& seeds, const std::function<int()>& program);

/// Chooses the disorder of a machine that is about to be made.
using Disturb = std::function<void(SimulatedOptions&, RuntimeOptions&)>;
/// Present while search_seeds() runs the program.
extern const Disturb* disturb;

}  // namespace tess::detail
