// Work for a real machine: a walk of so many steps, each of which depends on the one before, that
// takes a given CPU time. The number of steps depends on the machine and on the calibration, but
// the answer must not: the walk goes half the way and back, by an invertible step, and ends where
// it began if no step was wrong.
#pragma once

#include <cstdint>

namespace lb_lab {

/// Goes `n_steps` / 2 steps from a word, and as many back. Returns the word.
[[nodiscard]] std::uint64_t walk(std::uint64_t word, std::uint64_t n_steps);

/// Steps per second of CPU time on this core: the fastest of several runs of a millisecond, which
/// is the speed of a core that no other thread shares.
[[nodiscard]] double calibrate();

}  // namespace lb_lab
