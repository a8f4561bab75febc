#include "tests/fuzz/protocols/case.hpp"

#include "runtime/wire/machine/mpi.hpp"
#include "runtime/wire/machine/threads.hpp"

#include <array>
#include <cstdlib>

namespace tess::fuzz {
namespace {

std::mutex failures_mutex;
std::vector<std::string> failures;

template <class T, std::size_t n>
T one_of(const std::array<T, n>& choices, std::uint64_t seed, std::uint64_t salt) {
  return choices[mix(seed ^ salt) % n];
}

}  // namespace

Case case_of(std::uint64_t seed, int n_pes, On on, int n_processes) {
  Case out{.seed = seed, .on = on, .random = Random(mix(seed + 1))};
  test::Machine& machine = out.machine;
  machine.pes = n_pes;
  machine.seed = seed;
  if (on == On::job) machine.per_process = n_pes / n_processes;
  // Relative to a latency of 1000: a PE is faster than its messages, or they pile up.
  machine.cost = Time(one_of(std::array{100, 100, 300, 1500}, seed, 0x636f7374U));
  machine.reordering = one_of(std::array{0.5, 1.0}, seed, 0x6f726472U);
  // Enough for all, for one message, for about two, for a few.
  machine.options.messages.memory_bytes =
      one_of(std::array<std::uint64_t, 4>{32U << 20U, 1, 300, 3000}, seed, 0x6d656d6fU);
  // Vectors of this size, or more, travel apart from their message.
  machine.options.messages.attach_bytes =
      one_of(std::array<std::size_t, 4>{1, 100, 1000, 16'384}, seed, 0x61747461U);
  // A run of a scenario takes about 10⁵ events; a run with this many is a livelock.
  machine.most_events = 20'000'000;
  return out;
}

std::unique_ptr<Machine> make_job_machine(int pes_per_process) {
  int argc = 0;
  char** argv = nullptr;
  return make_mpi_machine(
      argc, argv, MpiOptions{.pes_per_process = pes_per_process, .pinning = detail::Pinning::none});
}

Result Case::run_message(std::function<void()> main) const {
  if (on == On::simulated) return machine.run(std::move(main));
  Setup setup;
  setup.machine =
      on == On::job ? make_job_machine(machine.per_process) : make_threads_machine(machine.pes);
  setup.options.seed = seed;
  setup.options.signals = on == On::job;
  Result result;
  setup.options.report = [&result](const std::string& line) { result.report.push_back(line); };
  result.exit_code = run_on(setup, std::move(main));
  return result;
}

void add_failure(std::string failure) {
  const std::lock_guard lock(failures_mutex);
  if (failures.size() < 5) failures.push_back(std::move(failure));
}

std::string take_failures() {
  const std::lock_guard lock(failures_mutex);
  std::string out;
  for (const std::string& one : failures) out += (out.empty() ? "" : "\n") + one;
  failures.clear();
  return out;
}

void expect_exit(const Result& result, int exit_code) {
  std::string lines;
  for (const std::string& line : result.report) lines += "; " + line;
  expect(result.exit_code == exit_code, "exit code ", result.exit_code, ", not ", exit_code, lines);
}

int n_not_delivered(const Result& result) {
  constexpr std::string_view begin = "tessera: ";
  for (const std::string& line : result.report)
    if (line.starts_with(begin) && line.ends_with("not delivered"))
      return std::atoi(line.c_str() + begin.size());
  return 0;
}

}  // namespace tess::fuzz
