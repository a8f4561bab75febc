#include "apps/protocol_fuzz/trial.hpp"

#include "runtime/machine/mpi.hpp"
#include "runtime/machine/simulated.hpp"
#include "runtime/machine/threads.hpp"

#include <array>

namespace tess::fuzz {
namespace {
// A run of a scenario takes about 10⁵ events; a run with this many is a livelock.
constexpr std::uint64_t most_events = 20'000'000;
}  // namespace

std::int32_t pes_of_seed(std::uint64_t seed) {
  constexpr std::array<std::int32_t, 6> choices{1, 2, 3, 4, 7, 8};
  return choices[mix(seed ^ 0x70657300U) % choices.size()];
}

std::unique_ptr<Machine> make_job_machine(std::int32_t pes_per_process) {
  int argc = 0;
  char** argv = nullptr;
  return make_mpi_machine(
      argc, argv, MpiOptions{.pes_per_process = pes_per_process, .pinning = detail::Pinning::none});
}

Trial::Trial(std::uint64_t seed, std::int32_t n_pes, On machine, std::int32_t n_processes)
    : seed_(seed),
      n_pes_(n_pes),
      pes_of_process_(n_pes / n_processes),
      machine_(machine),
      random_(mix(seed + 1)) {
  // Enough for all, for one message, for about two, for a few.
  constexpr std::array<std::uint64_t, 4> choices{32U << 20U, 1, 300, 3000};
  message_memory_ = choices[mix(seed ^ 0x6d656d6fU) % choices.size()];
}

Ending Trial::run_message(std::function<void()> main) {
  Ending ending;
  Setup setup;
  // A thread per run, which thousands of simulated runs would start.
  setup.options.signals = machine_ == On::job;
  if (machine_ == On::job) {
    setup.machine = make_job_machine(pes_of_process_);
    setup.options.seed = seed_;
  } else if (machine_ == On::threads) {
    setup.machine = make_threads_machine(n_pes_);
    setup.options.seed = seed_;
  } else {
    SimulatedOptions options;
    options.n_pes = n_pes_;
    options.seed = mix(seed_ * 16 + n_runs_++) >> 16U;
    // Relative to a latency of 1000: a PE is faster than its messages, or they pile up.
    constexpr std::array<int, 4> costs{100, 100, 300, 1500};
    options.cost = Time(costs[mix(*options.seed ^ 0x636f7374U) % costs.size()]);
    options.most_events = most_events;
    if (!forced_migration_) options.migration_chance = 0;
    setup.machine = make_simulated_machine(options);
    setup.options.seed = *options.seed;
    setup.options.migration_chance = migration_chance(options);
    setup.options.messages.memory_bytes = message_memory_;
    // Vectors of this size, or more, travel apart from their message.
    constexpr std::array<std::size_t, 4> attached_from{1, 100, 1000, 16'384};
    setup.options.messages.attach_bytes =
        attached_from[mix(*options.seed ^ 0x61747461U) % attached_from.size()];
  }
  setup.options.report = [&ending](const std::string& line) { ending.report += line + "\n"; };
  ending.exit_code = run_on(setup, std::move(main));
  return ending;
}

void Trial::add_failure(std::string failure) {
  constexpr std::size_t most = 5;
  const std::lock_guard lock(mutex_);
  if (failures_.size() < most) failures_.push_back(std::move(failure));
}

}  // namespace tess::fuzz
