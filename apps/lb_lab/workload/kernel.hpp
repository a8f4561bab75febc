// Work for a real machine: a walk of so many steps, each of which needs the one before, that takes
// the CPU time asked for. How many steps that is depends on the machine and on its mood at
// calibration, and the answer must not: so the walk goes half the way and back, by an invertible
// step, and ends where it began if no step was wrong.
#pragma once

#include <cstdint>

namespace lb_lab {

/// Goes `n_steps` / 2 steps from a word, and as many back: returns the word.
[[nodiscard]] std::uint64_t walk(std::uint64_t word, std::uint64_t n_steps);

/// Steps a second of CPU time on this core: the fastest of several millisecond runs, which is what
/// the core does when nobody shares it.
[[nodiscard]] double calibrate();

}  // namespace lb_lab
