#include "runtime/more/testing.hpp"
#include "runtime/more/testing/disorder.hpp"
#include "runtime/more/testing/trial.hpp"
#include "runtime/wire/machine/simulated.hpp"

#include <string_view>
#include <utility>

namespace tess::test {
namespace {

/// The text behind one of the beginnings of a line that reports an exception.
std::string exception_in(const std::vector<std::string>& report) {
  for (const std::string& line : report)
    for (const std::string_view begin : {"tessera: uncaught exception: ", "error: "})
      if (line.starts_with(begin)) return line.substr(begin.size(), line.find('\n') - begin.size());
  return {};
}

void check_options(const Machine& machine) {
  const auto refuse_unless = [](bool holds, const auto&... parts) {
    if (!holds) fail(ErrorCode::bad_argument, "tess::test::Machine: ", parts...);
  };
  const auto is_probability = [](double p) { return p >= 0 && p <= 1; };
  refuse_unless(machine.pes >= 1, "pes = ", machine.pes, "; give at least 1");
  refuse_unless(machine.per_process >= 0 &&
                    (machine.per_process == 0 || machine.pes % machine.per_process == 0),
                machine.pes, " PEs do not divide into processes of ", machine.per_process);
  refuse_unless(is_probability(machine.reordering), "reordering = ", machine.reordering,
                " is not a probability of 0 … 1");
  refuse_unless(is_probability(machine.migration.value_or(0)),
                "migration = ", machine.migration.value_or(0), " is not a probability of 0 … 1");
  refuse_unless(machine.cost.count() >= 0 && machine.latency.count() >= 0,
                "cost and latency must not be negative");
}

}  // namespace

std::string Result::failure() const {
  if (ok()) return {};
  std::string out = text("exit code ", exit_code);
  for (const std::string& line : report) out += "\n" + line;
  return out;
}

void Result::require_success() const {
  if (!ok()) throw Failure(failure());
}

Result Machine::run_message(std::function<void()> main) const {
  check_options(*this);
  detail::Trial own;
  detail::Trial* trial = detail::current_trial();
  if (trial == nullptr) {
    const auto repeat = detail::requested_repeat();
    if (repeat && repeat->seed == seed) own.keep = repeat->keep;
    trial = &own;
  }

  SimulatedOptions simulated;
  simulated.n_pes = pes;
  simulated.pes_per_process = per_process;
  simulated.latency = latency;
  simulated.cost = cost;
  simulated.seed = seed;
  simulated.migration_chance = migration;
  simulated.most_events = most_events;
  simulated.most_time = most_time;
  Result result;
  RuntimeOptions all = options;
  const detail::Disorder disorder(*trial, simulated, all, reordering);
  Setup setup{make_simulated_machine(simulated), all};
  setup.options.report = [&result](const std::string& line) { result.report.push_back(line); };
  result.exit_code = run_on(setup, std::move(main));
  result.exception = exception_in(result.report);
  return result;
}

}  // namespace tess::test
