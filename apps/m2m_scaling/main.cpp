// m2m_scaling SOURCE TARGET: one transfer on simulated machines of more and more PEs.
//
//     m2m_scaling kuhn:80 kuhn:81 --pes 1,16,64,256
//     m2m_scaling kuhn:200 kuhn:201 --pes 64,128,256,512,1024,2048 --out scaling
#include "apps/kit/write_file.hpp"
#include "apps/m2m_scaling/own_process.hpp"
#include "apps/m2m_scaling/report.hpp"
#include "apps/m2m_transfer/run/measure.hpp"
#include "m2m/transfer_kind.hpp"
#include "runtime/command_line.hpp"
#include "runtime/core/error.hpp"
#include "runtime/machine/simulated.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fmt/core.h>
#include <string>
#include <vector>

namespace m2m_scaling {
namespace {

using m2m_transfer::Request;

bool has_values_of(const Row& a, const Row& b) {
  return a.result_hash == b.result_hash && a.tally.counts == b.tally.counts;
}

/// One run. Returns the exit code.
int run_once(const Request& request, const tess::SimulatedOptions& machine, Row& row) {
  kit::Progress progress(stderr);
  tess::Setup setup{tess::make_simulated_machine(machine), {}};
  setup.options.seed = machine.seed.value_or(1);
  setup.options.migration_chance = migration_chance(machine);
  return tess::run(setup, [&]() -> tess::Task {
    m2m_transfer::Problem problem = co_await m2m_transfer::load(request);
    problem.collects = true;  // the time of it is a column
    co_await m2m_transfer::measure(problem, tess::create_group<m2m_transfer::Gauge>(), progress);
    const m2m_transfer::TransferReport& report = problem.reports.front();
    row = {report.pes, report.seconds, report.tally, report.result_hash};
  });
}

/// The fastest of several runs. Returns the exit code.
int run_fastest(const Request& request, const tess::SimulatedOptions& machine, std::int32_t n_runs,
                Row& best) {
  if (const int code = run_once(request, machine, best); code != 0) return code;
  for (std::int32_t i = 1; i < n_runs; ++i) {
    Row next;
    if (const int code = run_once(request, machine, next); code != 0) return code;
    if (!has_values_of(next, best)) {  // it is not repeated away
      fmt::print(stderr, "m2m_scaling: two runs on {} PEs give different values\n", machine.n_pes);
      return 1;
    }
    const double gather = std::min(best.seconds.gather, next.seconds.gather);
    if (distributed_seconds(next) < distributed_seconds(best)) best = next;
    best.seconds.gather = gather;
  }
  return 0;
}

/// The machines of --sim with so many PEs each. That of one PE has one process.
std::vector<tess::SimulatedOptions> machines_of(const std::string& sim,
                                                const std::vector<std::int32_t>& pes) {
  std::vector<tess::SimulatedOptions> machines;
  for (const std::int32_t n : pes)
    machines.push_back(tess::parse_simulated(fmt::format("pes={}{}{}{}", n, sim.empty() ? "" : ",",
                                                         sim, n == 1 ? ",per-process=1" : "")));
  return machines;
}

int study(int argc, char** argv) {
  Request request;
  std::vector<std::int32_t> pes{1, 4, 16, 64, 256};
  std::string sim = "latency=2us,bandwidth=10GB/s", out;
  std::int32_t repeat = 1;
  tess::CommandLine line("A transfer between two meshes on simulated machines of many PEs");
  line.option("SOURCE", request.source, "mesh, as for m2m_transfer");
  line.option("TARGET", request.target, "mesh, as for m2m_transfer");
  line.option("--pes", pes, "PEs of the machines").separated_by(',').between(1, 1 << 20);
  line.option("--sim", sim, "the machine's other parameters, as for m2m_transfer");
  request.per_pe = 4;
  line.option("--per-pe", request.per_pe, "chares per mesh and PE").between(1, 1 << 20);
  line.option("--kind KIND", request.kind, "how values follow from the source");
  line.option("--repeat", repeat, "runs per machine, of which the fastest counts")
      .between(1, 1000000);
  line.option("--out PREFIX", out, "write PREFIX.svg and PREFIX.csv");
  if (!line.parse(argc, argv, "")) return 0;
  if (request.source.empty() || request.target.empty())
    tess::fail(tess::ErrorCode::bad_argument,
               "give a source and a target mesh, such as kuhn:40 kuhn:41 (--help lists the "
               "arguments)");
  (void)tess::m2m::parse_transfer_kind(request.kind);
  if (sim.starts_with("pes=") || sim.find(",pes=") != std::string::npos)
    tess::fail(tess::ErrorCode::bad_argument, "--sim ", sim,
               " names a number of PEs; give them with --pes 1,4,16");
  if (!out.empty())
    for (const char* end : {".svg", ".csv"}) kit::require_writable("--out", out + end);
  std::ranges::sort(pes);
  std::vector<Row> rows;
  for (const tess::SimulatedOptions& machine : machines_of(sim, pes)) {
    Row row;
    const auto run = [&](Row& best) { return run_fastest(request, machine, repeat, best); };
    if (const int code = in_own_process(argv[0], run, row); code != 0) return code;
    rows.push_back(row);
    if (rows.size() == 1) fmt::print("{}", head());
    fmt::print("{}", m2m_scaling::line(row, rows.front()));
    std::fflush(stdout);
  }
  if (!out.empty()) draw(out, request.source + " to " + request.target, rows);
  for (const Row& row : rows)
    if (!has_values_of(row, rows.front())) {
      fmt::print(stderr, "m2m_scaling: {} PEs give other values than {}\n", row.pes,
                 rows.front().pes);
      return 1;
    }
  return 0;
}

}  // namespace
}  // namespace m2m_scaling

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return m2m_scaling::study(argc, argv); });
}
