#include "apps/task_bench/kernel.hpp"

#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace task_bench {
namespace {

/// The compiler takes it for used.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

void busy_wait(std::int64_t iterations) {
  std::int64_t value = 113;
  for (std::int64_t i = 0; i < iterations; ++i) value = value * 139 % 2147483647;
  keep(value);
}

/// 64 independent chains of a multiplication and an addition, of bounded values.
void compute(std::int64_t iterations) {
  std::array<double, 64> a;
  a.fill(1.2345);
  for (std::int64_t i = 0; i < iterations; ++i)
    for (double& x : a) x = x * 0.5 + 0.75;
  keep(a);
}

/// In each iteration the first half of a sample is copied onto its second.
void copy_samples(const Kernel& kernel, std::int64_t iterations, std::int64_t step,
                  std::span<std::byte> scratch) {
  const std::size_t sample = scratch.size() / static_cast<std::size_t>(kernel.samples);
  std::int64_t at = step * iterations % kernel.samples;
  for (std::int64_t i = 0; i < iterations; ++i) {
    std::byte* const begin = scratch.data() + static_cast<std::size_t>(at) * sample;
    std::memcpy(begin + sample / 2, begin, sample / 2);
    if (++at == kernel.samples) at = 0;
  }
  keep(scratch);
}

}  // namespace

const std::vector<std::string>& kernel_names() {
  static const std::vector<std::string> names{"empty", "busy_wait", "memory_bound", "compute_bound",
                                              "load_imbalance"};
  return names;
}

const std::string& name_of(KernelType type) {
  return kernel_names()[static_cast<std::size_t>(type)];
}

void refuse_name(std::string_view option, std::string_view name,
                 const std::vector<std::string>& names) {
  const std::string all = fmt::format("{}", fmt::join(names, ", "));
  tess::fail(tess::ErrorCode::bad_argument, option, ": there is no ", name, "; choose one of ", all,
             tess::did_you_mean(name, all));
}

KernelType parse_kernel(std::string_view name) {
  const auto& names = kernel_names();
  const auto at = std::ranges::find(names, name);
  if (at == names.end()) refuse_name("-kernel", name, names);
  return static_cast<KernelType>(at - names.begin());
}

std::int64_t iterations_of(const Kernel& kernel, std::int32_t graph, std::int64_t step,
                           std::int32_t point) {
  if (kernel.type != KernelType::load_imbalance) return kernel.iterations;
  std::uint64_t hash = tess::mix(0x696d62 ^ static_cast<std::uint64_t>(graph));
  if (!kernel.persistent) hash = tess::mix(hash ^ static_cast<std::uint64_t>(step));
  const double drawn = tess::Random(tess::mix(hash ^ static_cast<std::uint64_t>(point))).unit();
  return std::llround((1 + (drawn - 0.5) * kernel.imbalance) *
                      static_cast<double>(kernel.iterations));
}

void execute(const Kernel& kernel, std::int64_t iterations, std::int64_t step,
             std::span<std::byte> scratch) {
  switch (kernel.type) {
    case KernelType::empty:
      break;
    case KernelType::busy_wait:
      busy_wait(iterations);
      break;
    case KernelType::memory_bound:
      copy_samples(kernel, iterations, step, scratch);
      break;
    case KernelType::compute_bound:
    case KernelType::load_imbalance:
      compute(iterations);
      break;
  }
}

std::int64_t virtual_nanoseconds(const Kernel& kernel, std::int64_t iterations) {
  if (kernel.type == KernelType::empty) return 0;
  if (kernel.type == KernelType::memory_bound)
    return iterations * std::max<std::int64_t>(1, kernel.scratch_bytes / kernel.samples / 20);
  return 4 * iterations;
}

double calibrate(const Kernel& kernel, std::int64_t iterations) {
  using Clock = std::chrono::steady_clock;
  std::vector<std::byte> scratch(static_cast<std::size_t>(kernel.scratch_bytes));
  const auto seconds_of = [&](std::int64_t n_calls) {
    const auto began = Clock::now();
    for (std::int64_t call = 0; call < n_calls; ++call) execute(kernel, iterations, call, scratch);
    return std::chrono::duration<double>(Clock::now() - began).count();
  };
  // Of a kernel that takes so long two calls are enough.
  if (const double once = seconds_of(1); once > 0.02) return std::min(once, seconds_of(1));
  std::int64_t n_calls = 1;
  while (seconds_of(n_calls) < 2e-4 && n_calls < (std::int64_t{1} << 20)) n_calls *= 2;
  double least = seconds_of(n_calls);
  for (int run = 0; run < 10; ++run) least = std::min(least, seconds_of(n_calls));
  return least / static_cast<double>(n_calls);
}

std::uint64_t flops(const Kernel& kernel, std::uint64_t n_tasks, std::uint64_t n_iterations) {
  if (kernel.type != KernelType::compute_bound && kernel.type != KernelType::load_imbalance)
    return 0;
  return 2 * 64 * n_iterations + 64 * n_tasks;
}

std::uint64_t bytes(const Kernel& kernel, std::uint64_t n_iterations) {
  if (kernel.type != KernelType::memory_bound) return 0;
  return static_cast<std::uint64_t>(kernel.scratch_bytes) * n_iterations /
         static_cast<std::uint64_t>(kernel.samples);
}

void validate(const Kernel& kernel) {
  if (kernel.type == KernelType::memory_bound && kernel.scratch_bytes < 16 * kernel.samples)
    tess::fail(tess::ErrorCode::bad_argument,
               fmt::format("-scratch {}: memory_bound needs at least {}, 16 for each of its {} "
                           "samples (-sample)",
                           kernel.scratch_bytes, 16 * kernel.samples, kernel.samples));
  if (kernel.type != KernelType::load_imbalance && (kernel.imbalance > 0 || kernel.persistent))
    tess::fail(tess::ErrorCode::bad_argument,
               fmt::format("-imbalance: {} has none; choose -kernel load_imbalance",
                           name_of(kernel.type)));
}

}  // namespace task_bench
