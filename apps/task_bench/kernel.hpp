// The work of a task besides its inputs and outputs, as Task Bench defines it: nothing, a chain of
// integer steps, arithmetic on 64 doubles, or copies within a scratch buffer. load_imbalance is
// compute_bound with a random number of iterations. No messages here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace task_bench {

enum class KernelType : std::uint8_t {
  empty,
  busy_wait,
  memory_bound,
  compute_bound,
  load_imbalance,
};

/// In the order of KernelType.
[[nodiscard]] const std::vector<std::string>& kernel_names();
[[nodiscard]] const std::string& name_of(KernelType type);
/// Throws tess::Error that lists the names for any other.
[[nodiscard]] KernelType parse_kernel(std::string_view name);
/// Throws tess::Error for a name that is none of these.
[[noreturn]] void refuse_name(std::string_view option, std::string_view name,
                              const std::vector<std::string>& names);

struct Kernel {
  KernelType type = KernelType::empty;
  std::int64_t iterations = 0;
  std::int64_t samples = 16;       ///< memory_bound: parts of the scratch, one per iteration
  std::int64_t scratch_bytes = 0;  ///< of memory_bound, of each point
  double imbalance = 0;            ///< of load_imbalance: (1 ± imbalance / 2) × iterations
  bool persistent = false;         ///< the imbalance of a point is the same at every step
};

/// The iterations of one task.
[[nodiscard]] std::int64_t iterations_of(const Kernel& kernel, std::int32_t graph,
                                         std::int64_t step, std::int32_t point);

/// Runs so many iterations at a step. `scratch`: scratch_bytes of the point's own.
void execute(const Kernel& kernel, std::int64_t iterations, std::int64_t step,
             std::span<std::byte> scratch);

/// The nanoseconds that so many iterations take on the simulated machine: 4 per iteration, and
/// bytes at 20 GB/s.
[[nodiscard]] std::int64_t virtual_nanoseconds(const Kernel& kernel, std::int64_t iterations);

/// The seconds that a task of so many iterations takes on this core; measured in some milliseconds,
/// or two tasks if they take longer.
[[nodiscard]] double calibrate(const Kernel& kernel, std::int64_t iterations);

/// As Task Bench counts them.
[[nodiscard]] std::uint64_t flops(const Kernel& kernel, std::uint64_t n_tasks,
                                  std::uint64_t n_iterations);
[[nodiscard]] std::uint64_t bytes(const Kernel& kernel, std::uint64_t n_iterations);

/// Throws tess::Error if the options are inconsistent.
void validate(const Kernel& kernel);

}  // namespace task_bench
