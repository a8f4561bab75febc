#include "apps/lb_lab/workload/kernel.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/cpu_clock.hpp"

#include <algorithm>

namespace lb_lab {
namespace {

constexpr std::uint64_t factor = 0x5851f42d4c957f2d, summand = 0x14057b7ef767814f;

/// 1 / factor modulo 2^64, by Newton: each pass doubles the number of right bits.
constexpr std::uint64_t inverse() {
  std::uint64_t x = factor;
  for (int pass = 0; pass < 6; ++pass) x *= 2 - factor * x;
  return x;
}
static_assert(factor * inverse() == 1);

}  // namespace

std::uint64_t walk(std::uint64_t word, std::uint64_t n_steps) {
  for (std::uint64_t step = n_steps / 2; step > 0; --step) word = word * factor + summand;
  for (std::uint64_t step = n_steps / 2; step > 0; --step) word = (word - summand) * inverse();
  return word;
}

double calibrate() {
  constexpr std::uint64_t n_steps = 1'000'000;
  double best = 1e9;
  for (std::uint64_t run = 0; run < 10; ++run) {
    const double began = tess::thread_cpu_seconds();
    TESS_CHECK(walk(run, n_steps) == run, "a walk and back ended elsewhere");
    best = std::min(best, tess::thread_cpu_seconds() - began);
  }
  return static_cast<double>(n_steps) / best;
}

}  // namespace lb_lab
