#include "apps/m2m_transfer/study/pes.hpp"

#include "apps/kit/ladder.hpp"
#include "apps/m2m_transfer/run/measure.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <type_traits>
#include <unistd.h>

namespace m2m_transfer {
namespace {

[[noreturn]] void fail_of(const char* call) {
  fail(ErrorCode::environment, call, ": ", std::generic_category().message(errno),
       "; each machine is measured in a process of its own");
}

/// One run. Returns the exit code.
int run_once(const Request& request, const RuntimeOptions& options, const SimulatedOptions& machine,
             PesRow& row) {
  Setup setup{make_simulated_machine(machine), options};
  setup.options.seed = machine.seed.value_or(1);
  setup.options.migration_chance = migration_chance(machine);
  return tess::run(setup, [&]() -> Task {
    kit::Progress progress(nullptr);
    Problem problem = co_await load(request);
    problem.repeat = 1;       // each run places the meshes again
    problem.collects = true;  // the time of it is a column
    co_await measure(problem, create<Gauge>(each_pe), progress);
    const TransferReport& report = problem.reports.front();
    row = {report.pes, report.seconds, report.tally, report.result_hash};
  });
}

/// The fastest of several runs. Returns the exit code.
int run_fastest(const Request& request, const RuntimeOptions& options,
                const SimulatedOptions& machine, PesRow& best) {
  if (const int code = run_once(request, options, machine, best); code != 0) return code;
  for (std::int32_t i = 1; i < request.repeat; ++i) {
    PesRow next;
    if (const int code = run_once(request, options, machine, next); code != 0) return code;
    if (!next.has_values_of(best)) {  // it is not repeated away
      fmt::print(stderr, "m2m_transfer: two runs on {} PEs give different values\n", machine.n_pes);
      return 1;
    }
    const double gather = std::min(best.seconds.gather, next.seconds.gather);
    if (next.together() < best.together()) best = next;
    best.seconds.gather = gather;
  }
  return 0;
}

}  // namespace

bool PesRow::has_values_of(const PesRow& other) const {
  return result_hash == other.result_hash && tally.counts == other.tally.counts;
}

const kit::Rows<PesRow>& pes_rows() {
  using R = const PesRow&;
  using kit::Json;
  using kit::of;
  static constexpr kit::Column<PesRow> columns[] = {
      {"pes", "PEs", "6", of<&PesRow::pes>},
      {"setup_seconds", "set-up", "8.4f", [](R r) -> Json { return r.seconds.setup; }},
      {"broad_seconds", "broad", "8.4f", [](R r) -> Json { return r.seconds.broad; }},
      {"narrow_seconds", "narrow", "8.4f", [](R r) -> Json { return r.seconds.narrow; }},
      {"apply_seconds", "apply", "8.4f", [](R r) -> Json { return r.seconds.apply; }},
      {"seconds", "together", "8.4f", [](R r) -> Json { return r.together(); }},
      {"speed_up", "speed-up", "8.2f", of<&PesRow::speed_up>},
      {"efficiency", "efficiency", "10.2f", of<&PesRow::efficiency>},
      {"gather_seconds", "gather", "8.4f", [](R r) -> Json { return r.seconds.gather; }},
      {"result_hash", "result", "16", [](R r) -> Json { return kit::hex(r.result_hash); }}};
  static const kit::Rows<PesRow> rows(columns);
  return rows;
}

Picture picture_of(const std::vector<PesRow>& rows, const std::string& title) {
  kit::Chart chart{
      .title = title, .x_label = "PEs", .y_label = "seconds", .x_log = true, .y_log = true};
  PesRow ideal = rows.front();
  for (const PesRow& row : rows) {
    chart.x_ticks.push_back(row.pes);
    kit::add_point(chart, "set-up", row.pes, row.seconds.setup);
    kit::add_point(chart, "broad", row.pes, row.seconds.broad);
    kit::add_point(chart, "narrow", row.pes, row.seconds.narrow);
    kit::add_point(chart, "apply", row.pes, row.seconds.apply);
    kit::add_point(chart, "together", row.pes, row.together());
    kit::add_point(chart, "together and gathered", row.pes, row.together() + row.seconds.gather);
    kit::add_point(chart, "together, ideal", row.pes, ideal.together() * ideal.pes / row.pes);
  }
  chart.series.back().style = kit::Style::dashes;
  return {"pes_time", std::move(chart)};
}

std::vector<SimulatedOptions> machines_of(std::vector<std::int32_t> pes, const std::string& keys) {
  std::ranges::sort(pes);
  std::vector<SimulatedOptions> machines;
  for (const std::int32_t n : pes) machines.push_back(kit::machine_of(keys, n));
  return machines;
}

int measure(const char* program, const Request& request, const RuntimeOptions& options,
            const SimulatedOptions& machine, PesRow& row) {
  static_assert(std::is_trivially_copyable_v<PesRow>);
  // Both processes see the row there.
  void* const shared =
      ::mmap(nullptr, sizeof row, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) fail_of("mmap");
  auto* const measured = new (shared) PesRow;
  std::fflush(nullptr);  // otherwise the child prints it, too
  const pid_t child = ::fork();
  if (child < 0) fail_of("fork");
  if (child == 0) {
    (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it ends with the parent
    const int code =
        guarded(program, [&] { return run_fastest(request, options, machine, *measured); });
    std::fflush(nullptr);
    std::_Exit(code);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  row = *measured;
  ::munmap(shared, sizeof row);
  if (WIFSIGNALED(status))
    fail(ErrorCode::environment, "the process that measured was ended by signal ", WTERMSIG(status),
         "; if it was 9, the memory may not have sufficed");
  return WEXITSTATUS(status);
}

}  // namespace m2m_transfer
